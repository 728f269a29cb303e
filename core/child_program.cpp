#include "core/child_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "core/check.hpp"
#include "core/error.hpp"

namespace binpick {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kKept = 4096;  // bytes of what it says
constexpr int kLook = 5;             // ms between looks at a child that says nothing

/// Both ends closed at the end.
struct Pipe {
  int ends[2] = {-1, -1};
  Pipe() {
    if (::pipe2(ends, O_CLOEXEC) != 0) throw AssetError(std::string("cannot make a pipe: ") + std::strerror(errno));
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close(0);
    close(1);
  }
  void close(int end) {
    if (ends[end] >= 0) ::close(ends[end]);
    ends[end] = -1;
  }
};

/// Between fork and exec only calls that are safe when other threads were running.
[[noreturn]] void become(char* const* argv, const char* folder, const Pipe& talk, const Pipe& trouble) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a killed parent leaves none behind
  ::signal(SIGINT, SIG_DFL);
  ::signal(SIGXFSZ, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDONLY);
  bool good = nothing >= 0 && ::dup2(nothing, STDIN_FILENO) >= 0 && ::dup2(talk.ends[1], STDOUT_FILENO) >= 0 &&
              ::dup2(talk.ends[1], STDERR_FILENO) >= 0 && ::chdir(folder) == 0;
  if (good) ::execvp(argv[0], argv);
  const int error = errno;
  good = ::write(trouble.ends[1], &error, sizeof error) == sizeof error;
  ::_exit(good ? 127 : 126);
}

enum class Heard { kSomething, kNothing, kEnd };

/// Takes a block of what has arrived.
Heard take(int fd, std::string& said) {
  char block[4096];
  const ssize_t n = ::read(fd, block, sizeof block);
  if (n < 0) return errno == EINTR || errno == EAGAIN ? Heard::kNothing : Heard::kEnd;
  said.append(block, static_cast<std::size_t>(n));
  if (said.size() > kKept) said.erase(0, said.size() - kKept);
  return n > 0 ? Heard::kSomething : Heard::kEnd;
}

/// Listens until the child ends (true) or its time is over. It is not buried yet, so that its group's number stays its
/// own.
bool listen_until(pid_t child, int fd, Clock::time_point deadline, std::string& said) {
  bool open = true;
  for (;;) {
    siginfo_t info{};
    if (::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child)
      return true;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    pollfd ear{open ? fd : -1, POLLIN, 0};
    if (::poll(&ear, 1, static_cast<int>(std::min<long long>(left, kLook))) > 0) open = take(fd, said) != Heard::kEnd;
  }
}

}  // namespace

ProgramEnd run_child_program(const std::vector<std::string>& command, const std::string& folder, double seconds) {
  BP_CHECK(!command.empty() && seconds > 0, command.size() << " items, " << seconds << " s");
  std::vector<char*> argv;
  for (const std::string& item : command) argv.push_back(const_cast<char*>(item.c_str()));
  argv.push_back(nullptr);
  Pipe talk, trouble;
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  const pid_t child = ::fork();
  if (child < 0) throw AssetError(std::string("cannot start a process: ") + std::strerror(errno));
  if (child == 0) become(argv.data(), folder.c_str(), talk, trouble);
  ::setpgid(child, child);  // whoever of the two comes first
  talk.close(1);
  trouble.close(1);
  int error = 0;
  if (::read(trouble.ends[0], &error, sizeof error) == sizeof error) {
    ::waitpid(child, nullptr, 0);
    throw AssetError(command[0] + ": cannot be started: " + std::strerror(error));
  }
  ProgramEnd end;
  int status = 0;
  ::fcntl(talk.ends[0], F_SETFL, O_NONBLOCK);
  end.timed_out = !listen_until(child, talk.ends[0], deadline, end.said);
  ::kill(-child, SIGKILL);  // with what it has started and left behind
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  while (take(talk.ends[0], end.said) == Heard::kSomething) {
  }
  end.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return end;
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return "";
  const std::size_t begin = text.find_last_of('\n', end);
  std::string line = text.substr(begin == std::string::npos ? 0 : begin + 1);
  line.resize(line.find_last_not_of(" \t\r\n") + 1);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < ' ' || c == 127; }, '?');
  return line;
}

}  // namespace binpick

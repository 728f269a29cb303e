#include "core/isolated.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>

#include "core/error.hpp"

namespace binpick {
namespace {

constexpr unsigned kWallFactor = 10;  // a child that waits for ever uses no processor time

bool write_whole(int fd, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::write(fd, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

std::string read_whole(int fd) {
  std::string bytes;
  char buffer[1 << 16];
  while (true) {
    const ssize_t n = ::read(fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return bytes;
    bytes.append(buffer, static_cast<std::size_t>(n));
  }
}

/// The child: nothing of the parent's is flushed, closed or printed twice.
[[noreturn]] void be_the_child(int fd, const std::function<std::string()>& body, unsigned cpu_seconds) {
  const rlimit limit{cpu_seconds, cpu_seconds};
  ::setrlimit(RLIMIT_CPU, &limit);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM, SIGTERM, SIGINT}) {
    std::signal(signal, SIG_DFL);
  }
  ::alarm(kWallFactor * cpu_seconds);
  const int sink = ::open("/dev/null", O_WRONLY);
  if (sink >= 0) {
    ::dup2(sink, STDOUT_FILENO);
    ::dup2(sink, STDERR_FILENO);
  }
  bool good = false;
  try {
    const std::string bytes = body();
    const std::uint64_t size = bytes.size();
    char head[sizeof size];
    std::memcpy(head, &size, sizeof size);
    good = write_whole(fd, head, sizeof size) && write_whole(fd, bytes.data(), bytes.size());
  } catch (...) {
    good = false;  // the parent sees that nothing came
  }
  ::_exit(good ? 0 : 1);
}

}  // namespace

std::optional<std::string> run_isolated(const std::function<std::string()>& body, unsigned cpu_seconds) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw StorageError(std::string("cannot make a pipe: ") + std::strerror(errno));
  const pid_t child = ::fork();
  if (child < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    throw StorageError(std::string("cannot start a process: ") + std::strerror(error));
  }
  if (child == 0) be_the_child(ends[1], body, cpu_seconds);
  ::close(ends[1]);
  const std::string bytes = read_whole(ends[0]);
  ::close(ends[0]);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  std::uint64_t size = 0;
  if (bytes.size() < sizeof size) return {};
  std::memcpy(&size, bytes.data(), sizeof size);
  if (bytes.size() - sizeof size != size) return {};  // it died while it wrote
  return bytes.substr(sizeof size);
}

}  // namespace binpick

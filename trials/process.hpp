// Private to trials: a child process with a pipe each way, read line by line.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace binpick {

class ChildProcess {
 public:
  /// Starts `arguments[0]` as the head of a process group of its own; throws std::runtime_error. `memory`: bytes of
  /// data that it may have, 0: any.
  explicit ChildProcess(const std::vector<std::string>& arguments, double memory = 0);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  int output() const { return from_child_; }  ///< to poll for reading
  bool send(const std::string& text);         ///< false when the child no longer listens
  void close_input();                         ///< the child sees the end of its input
  /// Takes what has arrived; false at the end of the child's output.
  bool receive();
  std::optional<std::string> next_line();
  /// Waits for the end: exit code, or 128 + signal.
  int wait();
  void kill();                                       ///< it and what it has started
  double resident_bytes() const;                     ///< 0 when it is gone
  double peak_bytes() const { return peak_bytes_; }  ///< once waited for

 private:
  pid_t pid_ = -1;
  int to_child_ = -1;
  int from_child_ = -1;
  std::string buffer_;
  double peak_bytes_ = 0;
};

}  // namespace binpick

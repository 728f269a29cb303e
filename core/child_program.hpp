// A foreign program, run to its end or to its time limit. It leads a process group of its own, so that whatever it has
// started ends with it; its standard input is empty, and what it says is kept for messages. Linux.
#pragma once

#include <string>
#include <vector>

namespace binpick {

struct ProgramEnd {
  bool timed_out = false;
  int code = 0;      ///< exit code, or 128 + signal
  std::string said;  ///< the end of what it wrote to standard output and standard error
};

/// Runs `command` in the working directory `folder` for at most `seconds` of the wall clock; then it and its group are
/// killed. A program named without a slash is looked for along PATH. Throws AssetError when it cannot be started.
ProgramEnd run_child_program(const std::vector<std::string>& command, const std::string& folder, double seconds);

/// The last line of a text that is not blank, without characters a terminal would obey.
std::string last_line(const std::string& text);

}  // namespace binpick

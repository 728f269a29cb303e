// Runs the program as a user would and keeps what it said.
#pragma once

#include <string>

namespace binpick {

struct ProgramRun {
  int code = 0;
  std::string out, err;
};

/// `arguments` go through the shell after the program's path; `before` runs in the same shell first (ulimit, ..).
ProgramRun run_program(const std::string& arguments, const std::string& before = "");

/// A folder of its own for one test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string path(const std::string& name = "") const { return name.empty() ? path_ : path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace binpick

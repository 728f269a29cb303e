#include "tests/tools/run_program.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include "core/file_io.hpp"

namespace binpick {

ProgramRun run_program(const std::string& arguments, const std::string& before) {
  const TemporaryFolder folder;
  const std::string command = "{ " + before + (before.empty() ? "" : "; ") + BINPICK_PROGRAM " " + arguments + "; } >" +
                              folder.path("out") + " 2>" + folder.path("err");
  const int status = std::system(("bash -c '" + command + "'").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(folder.path("out")),
          read_file(folder.path("err"))};
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "binpick_test_XXXXXX").string();
  path_ = ::mkdtemp(name.data());
}

TemporaryFolder::~TemporaryFolder() { std::filesystem::remove_all(path_); }

namespace {

TEST(Program, SaysItsVersionAndItsCommands) {
  EXPECT_EQ(run_program("--version").out, "binpick 0.1.0\n");
  const ProgramRun help = run_program("--help");
  EXPECT_EQ(help.code, 0);
  for (const char* command : {"trial", "campaign", "report", "check", "list"})
    EXPECT_NE(help.out.find(command), std::string::npos) << command;
  EXPECT_EQ(help.out.find("worker"), std::string::npos);
}

}  // namespace
}  // namespace binpick

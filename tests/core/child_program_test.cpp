// Foreign programs: what they say and how they end, killed with all they started when their time is over.
#include "core/child_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "temp_folder.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

ProgramEnd run(const std::string& script, const std::string& folder, double seconds = 60) {
  return run_child_program({"/bin/sh", "-c", script}, folder, seconds);
}

/// Neither running nor waiting: gone, or dead and not yet buried.
bool is_gone(const std::string& pid) {
  std::ifstream stat("/proc/" + pid + "/stat");
  std::string number, name, state;
  if (!(stat >> number >> name >> state)) return true;
  return state == "Z" || state == "X";
}

TEST(ChildProgram, SaysHowItEndedAndWhatWasSaid) {
  const TempFolder folder;
  const ProgramEnd good = run("echo one; echo two >&2; pwd > here", folder.at(""));
  EXPECT_EQ(good.code, 0);
  EXPECT_FALSE(good.timed_out);
  EXPECT_THAT(good.said, HasSubstr("one\n"));
  EXPECT_THAT(good.said, HasSubstr("two\n"));
  EXPECT_EQ(std::filesystem::weakly_canonical(folder.at("")).string() + "\n", read_file(folder.at("here")));
  EXPECT_EQ(run("exit 7", folder.at("")).code, 7);
  EXPECT_EQ(run("kill -9 $$", folder.at("")).code, 128 + 9);
}

TEST(ChildProgram, KeepsTheEndOfALongTalk) {
  const TempFolder folder;
  const ProgramEnd end = run("i=0; while [ $i -lt 3000 ]; do echo line $i; i=$((i+1)); done", folder.at(""));
  EXPECT_EQ(end.code, 0);
  EXPECT_LE(end.said.size(), 4096u);
  EXPECT_EQ(last_line(end.said), "line 2999");
}

TEST(ChildProgram, HasNothingOnItsInput) {
  const TempFolder folder;
  EXPECT_EQ(last_line(run("cat; echo end", folder.at("")).said), "end");
}

TEST(ChildProgram, IsKilledWithAllItStarted) {
  const TempFolder folder;
  const ProgramEnd end = run("sleep 1000 & echo $! > pid; echo started; sleep 1000", folder.at(""), 1.0);
  EXPECT_TRUE(end.timed_out);
  EXPECT_EQ(last_line(end.said), "started");
  const std::string pid = last_line(read_file(folder.at("pid")));
  for (int i = 0; i < 200 && !is_gone(pid); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(is_gone(pid)) << pid;
}

TEST(ChildProgram, WhatItLeavesBehindEndsWithIt) {
  const TempFolder folder;
  const ProgramEnd end = run("sleep 1000 & echo $! > pid", folder.at(""));
  EXPECT_FALSE(end.timed_out);
  const std::string pid = last_line(read_file(folder.at("pid")));
  for (int i = 0; i < 200 && !is_gone(pid); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(is_gone(pid)) << pid;
}

TEST(ChildProgram, OneThatCannotBeStartedIsNamed) {
  const TempFolder folder;
  try {
    run_child_program({"no_such_program_of_ours"}, folder.at(""), 1);
    FAIL();
  } catch (const AssetError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no_such_program_of_ours: cannot be started"));
  }
  EXPECT_THROW(run_child_program({"/bin/true"}, folder.at("nowhere"), 1), AssetError);
}

TEST(LastLine, IsTheLastThatIsNotBlankAndHarmless) {
  EXPECT_EQ(last_line(""), "");
  EXPECT_EQ(last_line(" \n\n"), "");
  EXPECT_EQ(last_line("a\nb  \n\n"), "b");
  EXPECT_EQ(last_line("x\x1b[31mred"), "x?[31mred");
}

}  // namespace
}  // namespace binpick

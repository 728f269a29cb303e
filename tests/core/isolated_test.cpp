#include "core/isolated.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <stdexcept>

namespace binpick {
namespace {

TEST(Isolated, BringsBackTheBytes) {
  EXPECT_EQ(run_isolated([] { return std::string("answer"); }, 10), "answer");
  EXPECT_EQ(run_isolated([] { return std::string(); }, 10), "");
  const std::string large(5'000'000, '\0');  // more than a pipe holds
  EXPECT_EQ(run_isolated([&] { return large; }, 10), large);
}

TEST(Isolated, SurvivesWhatKillsTheChild) {
  EXPECT_FALSE(run_isolated(
      []() -> std::string {
        std::raise(SIGSEGV);
        return "not reached";
      },
      10));
  EXPECT_FALSE(run_isolated([]() -> std::string { std::abort(); }, 10));
  EXPECT_FALSE(run_isolated([]() -> std::string { throw std::runtime_error("stray"); }, 10));
  EXPECT_FALSE(run_isolated(
      []() -> std::string {
        volatile bool forever = true;
        while (forever) {
        }
        return "not reached";
      },
      1));
}

TEST(Isolated, DropsWhatTheChildPrints) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  run_isolated(
      [] {
        std::fputs("noise\n", stderr);
        std::puts("noise");
        std::fflush(stdout);
        return std::string("answer");
      },
      10);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace binpick

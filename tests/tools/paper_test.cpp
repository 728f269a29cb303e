// binpick paper: the page, its pictures and figures from two small scenes, and what users get wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

std::string scene(const std::string& more) {
  return "part: " BINPICK_SOURCE_DIR "/assets/parts/bearing_6914/part.yaml\ncount: 1\ncell: " BINPICK_SOURCE_DIR
         "/assets/cells/mz07_three_cups.yaml\nsensor: {type: ideal}\nestimator: {type: oracle}\n"
         "trial: {max_picks: 1}\n" +
         more;
}

TEST(Paper, ThePageHasFourTablesAndItsErrorsAreThoseOfTheCalibration) {
  const TemporaryFolder folder;
  make_folder(folder.path("scenes"));
  write_file(folder.path("scenes/paper_bearing.yaml"),
             scene("calibration: {offset: {translation: [3 mm, 0, 4 mm]}}\n"));
  write_file(folder.path("scenes/bearing_bin.yaml"), scene(""));
  const ProgramRun run = run_program("paper --seeds 100:101 --scenes " + folder.path("scenes") + " --out " +
                                     folder.path("out") + " --json " + folder.path("p.json"));
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* title : {"## Table 1", "## Table 2", "## Table 3", "## Table 4", "own slips"})
    EXPECT_THAT(run.out, HasSubstr(title));
  EXPECT_EQ(read_file(folder.path("out/paper.md")), run.out);
  EXPECT_TRUE(std::filesystem::exists(folder.path("out/images/paper_1_estimates.png")));
  EXPECT_FALSE(std::filesystem::exists(folder.path("out/.paper_pictures")));
  const nlohmann::json json = nlohmann::json::parse(read_file(folder.path("p.json")));
  const nlohmann::json& verified = json.at("verification");
  ASSERT_EQ(verified.size(), 3u);
  // The oracle is exact: what is left of the pose is the calibration, whole, wherever the camera looks from.
  EXPECT_NEAR(verified[0].at("length_m").at("mean").get<double>(), 0.005, 1e-9);
  EXPECT_LT(verified[1].at("length_m").at("mean").get<double>(), 1e-9);
  EXPECT_GT(verified[2].at("length_m").at("mean").get<double>(), 1e-4);  // the chain's
  EXPECT_EQ(json.at("rounds").size(), 2u);
}

TEST(Paper, WhatUsersGetWrongIsSaidInOneLine) {
  const TemporaryFolder folder;
  const ProgramRun none = run_program("paper --scenes " + folder.path("nowhere"));
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("paper_bearing.yaml"));
  EXPECT_EQ(run_program("paper --seeds 5:5").code, 2);
}

}  // namespace
}  // namespace binpick

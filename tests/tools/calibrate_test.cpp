// binpick calibrate and validate calibration: every row, the quick checks, and what users get wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

const std::string kScene = BINPICK_SOURCE_DIR "/scenes/bearing_bin.yaml";

TEST(Calibrate, ARowForEveryMethodAndSourceAndErrorsAsTold) {
  const TemporaryFolder folder;
  write_file(folder.path("errors.yaml"), "{corner: 0, focal: 0, centre: 0, plate_shift: 1 mm, plate_turn: 0}\n");
  const ProgramRun run = run_program("calibrate " + kScene + " --seeds 5000:5004 --poses 4 --errors " +
                                     folder.path("errors.yaml") + " --json " + folder.path("c.json"));
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json rows = nlohmann::json::parse(read_file(folder.path("c.json")));
  ASSERT_EQ(rows.size(), 3u * 7u);  // chain, park, horaud; six sources and all
  for (const nlohmann::json& row : rows) {
    if (row.at("source") == "corner noise") {
      EXPECT_LT(row.at("shift_rms").get<double>(), 1e-9);
    }
    if (row.at("source") == "plate on the flange" && row.at("method") == "chain") {
      EXPECT_NEAR(row.at("shift_predicted").get<double>(), std::sqrt(3.0) * 1e-3, 1e-6);
    }
  }
  EXPECT_THAT(run.out, HasSubstr("| chain | all |"));
}

TEST(Calibrate, WhatUsersGetWrongIsSaidInOneLine) {
  const TemporaryFolder folder;
  write_file(folder.path("errors.yaml"), "{corners: 0.1}\n");
  const ProgramRun key = run_program("calibrate " + kScene + " --errors " + folder.path("errors.yaml"));
  EXPECT_EQ(key.code, 2);
  EXPECT_THAT(key.err, HasSubstr("errors.yaml:1"));
  write_file(folder.path("scene.yaml"),
             "name: fixed\npart: " BINPICK_SOURCE_DIR
             "/assets/parts/bearing_6914/part.yaml\ncount: 1\ncell:\n  base: " BINPICK_SOURCE_DIR
             "/assets/cells/mz07_three_cups.yaml\n  look: {joints: [0, 0, 0, 0, 90 deg, 0]}\n"
             "  camera: {mount: fixed, pose: {xyz: [495 mm, 0, 900 mm], rpy: [180 deg, 0, 0]}}\n"
             "sensor: {type: ideal}\nestimator: {type: ppf}\n");
  const ProgramRun fixed = run_program("calibrate " + folder.path("scene.yaml"));
  EXPECT_EQ(fixed.code, 2);
  EXPECT_THAT(fixed.err, HasSubstr("not on the flange"));
}

TEST(ValidateCalibration, QuickFormPasses) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program("validate calibration --quick --json " + folder.path("v.json"), "cd " BINPICK_SOURCE_DIR);
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  const nlohmann::json lines = nlohmann::json::parse(read_file(folder.path("v.json")));
  for (const char* id : {"V-D1", "V-D2", "V-D3", "V-D4"})
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [&](const auto& line) { return line.at("id") == id; })) << id;
}

}  // namespace
}  // namespace binpick

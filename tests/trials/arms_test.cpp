// Arms of five makes, each in a cell of its own: URDF in, one part out of the bin and into the tray, with estimates
// made from the truth. That arm and tool touched neither bin nor cell is the physics world's word, not the planner's.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "trials/trial.hpp"

namespace binpick {
namespace {

class ForeignArm : public testing::TestWithParam<const char*> {};

TEST_P(ForeignArm, PicksABearing) {
  const std::string assets = std::string(BINPICK_SOURCE_DIR) + "/assets/";
  const std::string file = testing::TempDir() + "scene_" + GetParam() + ".yaml";
  std::ofstream(file) << "part: " << assets << "parts/bearing_6914/part.yaml\ncount: 2\ncell: " << assets << "cells/"
                      << GetParam()
                      << ".yaml\nsensor: {type: ideal}\nestimator: {type: oracle}\ntrial: {max_picks: 1}\n";
  Scenario scenario = read_scenario(file);
  TrialContext context = make_trial_context(scenario);
  const TrialRecord record = run_trial(scenario, Seed{11}, context);
  ASSERT_TRUE(record.error.empty()) << record.error;
  ASSERT_EQ(record.picks.size(), 1u);
  EXPECT_EQ(record.picks[0].outcome, PickOutcome::kSucceeded)
      << to_string(record.picks[0].outcome) << ' ' << record.picks[0].reason;
  EXPECT_EQ(record.placed, 1);
}

INSTANTIATE_TEST_SUITE_P(Cells, ForeignArm,
                         testing::Values("ur5e", "kr6_r900", "lrmate_200id", "tx2_60l", "irb1200_5_90"));

}  // namespace
}  // namespace binpick

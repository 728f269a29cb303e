// Arms of five makes, each in a cell of its own: URDF in, one part out of the bin and into the tray, with estimates
// made from the truth. That arm and tool touched neither bin nor cell is the physics world's word, not the planner's.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/error.hpp"
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

TEST(ArmPackages, WhereTheyLieSaysNothingAndTheyAreKept) {
  const std::string assets = std::string(BINPICK_SOURCE_DIR) + "/assets/", folder = testing::TempDir() + "packages/";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder + "elsewhere/src");
  std::filesystem::copy(assets + "arms/irb1200_description", folder + "elsewhere/src/irb1200_description",
                        std::filesystem::copy_options::recursive);
  std::filesystem::copy_file(assets + "arms/irb1200_description/urdf/irb1200_5_90.urdf", folder + "arm.urdf");
  const auto scene = [&](const std::string& name, const std::string& more) {
    std::ofstream(folder + name) << "name: same\npart: " << assets
                                 << "parts/bearing_6914/part.yaml\ncount: 1\ncell: {base: " << assets
                                 << "cells/irb1200_5_90.yaml" << more
                                 << "}\nsensor: {type: ideal}\nestimator: {type: oracle}\n";
    return read_scenario(folder + name);
  };
  const Scenario here = scene("here.yaml", "");
  const Scenario there = scene("there.yaml", ", arm: arm.urdf, arm_packages: [./elsewhere/src]");
  EXPECT_EQ(scenario_hash(there), scenario_hash(here));
  // What is written replays from another folder.
  std::filesystem::create_directories(folder + "run");
  std::ofstream(folder + "run/scenario.yaml") << expanded_yaml(there, folder + "run");
  EXPECT_EQ(scenario_hash(read_scenario(folder + "run/scenario.yaml")), scenario_hash(here));
  // Another mesh is another arm.
  const std::string bytes =
      "solid other\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 100 0 0\nvertex 0 100 400\n"
      "endloop\nendfacet\nendsolid other\n";
  std::ofstream(folder + "elsewhere/src/irb1200_description/meshes/link_2.stl") << bytes;
  EXPECT_NE(scenario_hash(read_scenario(folder + "there.yaml")), scenario_hash(here));
  EXPECT_THROW(scene("bad.yaml", ", arm: arm.urdf, arm_packages: [elsewhere/src]"), SpecError);
}

INSTANTIATE_TEST_SUITE_P(Cells, ForeignArm,
                         testing::Values("ur5e", "kr6_r900", "lrmate_200id", "tx2_60l", "irb1200_5_90"));

}  // namespace
}  // namespace binpick

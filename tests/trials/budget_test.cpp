// Every row of an error budget is the scene with one stage told the truth and nothing else changed.
#include "trials/budget.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/error.hpp"
#include "core/file_io.hpp"

namespace binpick {
namespace {

const std::string kScenes = std::string(BINPICK_SOURCE_DIR) + "/scenes/";

BudgetPlan plan_of(const std::string& scene) {
  BudgetPlan plan;
  plan.scene = kScenes + scene;
  plan.first_seed = 5000;
  plan.end_seed = 5002;
  plan.translation = {0.001, 0.003};
  plan.rotation = {0.05};
  return plan;
}

std::map<std::string, Scenario> cells_of(const std::string& text) {
  const std::string file = testing::TempDir() + "budget_test.yaml";
  write_file(file, text);
  const SweepSetup sweep = read_sweep(file);
  std::map<std::string, Scenario> cells;
  for (std::size_t c = 0; c < sweep.plan.cells.size(); ++c)
    cells.emplace(sweep.plan.cells[c].values.front(), cell_scenario(sweep, c));
  return cells;
}

TEST(Budget, EveryRowChangesItsOwnStage) {
  const Scenario base = read_scenario(kScenes + "bearing_bin_chain.yaml");
  const BudgetFiles files = budget_files(plan_of("bearing_bin_chain.yaml"));
  EXPECT_TRUE(files.absent.empty());
  auto cells = cells_of(files.stages);
  ASSERT_EQ(cells.size(), 8u);
  Scenario plain = cells.at("as it is");
  plain.name = base.name;  // a sweep's scenes have names of their own
  EXPECT_EQ(scenario_hash(plain), scenario_hash(base));
  Scenario depth = cells.at("depth");
  EXPECT_EQ(depth.sensor_type, "ideal");
  EXPECT_EQ(depth.cell.camera.intrinsics.width, base.cell.camera.intrinsics.width);
  EXPECT_DOUBLE_EQ(depth.cell.camera.intrinsics.fx, base.cell.camera.intrinsics.fx);
  EXPECT_EQ(cells.at("pose").estimator_type, "oracle");
  EXPECT_TRUE(cells.at("calibration").calibration.perfect());
  EXPECT_TRUE(cells.at("segmentation").oracles.segmentation);
  EXPECT_TRUE(cells.at("planning").oracles.planning);
  EXPECT_EQ(cells.at("planning").planning.search_checks, 10 * base.planning.search_checks);
  EXPECT_TRUE(cells.at("seal").oracles.seal);
  const Scenario& all = cells.at("all of them");
  EXPECT_EQ(all.sensor_type, "ideal");
  EXPECT_EQ(all.estimator_type, "oracle");
  EXPECT_TRUE(all.calibration.perfect() && all.oracles.planning && all.oracles.seal);
  for (const char* name : {"segmentation", "planning", "seal", "calibration"})
    EXPECT_EQ(cells.at(name).sensor_type, "disparity") << name;
}

TEST(Budget, ErrorsAreThoseOfTheOracle) {
  auto cells = cells_of(budget_files(plan_of("bearing_bin_chain.yaml")).errors);
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells.at("none").oracle.translation_error, 0);
  EXPECT_TRUE(cells.at("none").calibration.perfect()) << "no error but the stated one";
  EXPECT_DOUBLE_EQ(cells.at("translation 0.003").oracle.translation_error, 0.003);
  EXPECT_DOUBLE_EQ(cells.at("rotation 0.05").oracle.rotation_error, 0.05);
  EXPECT_EQ(cells.at("rotation 0.05").oracle.translation_error, 0);
}

TEST(Budget, WhatIsPerfectAlreadyHasNoRow) {
  const BudgetFiles files = budget_files(plan_of("bearing_bin_oracle.yaml"));
  EXPECT_THAT(files.absent, testing::IsSupersetOf({"pose", "segmentation", "calibration"}));
  EXPECT_EQ(cells_of(files.stages).count("pose"), 0u);
}

TEST(Budget, RefusesWhatItCannotMean) {
  EXPECT_THROW(budget_files(plan_of("bearing_bin_two_cameras.yaml")), SpecError);
  BudgetPlan plan = plan_of("bearing_bin.yaml");
  plan.translation = {0.003, 0.001};
  EXPECT_THROW(budget_files(plan), SpecError);
}

}  // namespace
}  // namespace binpick

// Sweeps from their file to the scenarios of their cells.

#include "trials/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/error.hpp"
#include "core/quantity.hpp"
#include "tests/core/temp_folder.hpp"
#include "trials/run_merge.hpp"
#include "trials/sweep_run.hpp"

namespace binpick {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kBase = std::string(BINPICK_SOURCE_DIR) + "/scenes/ci/bearing_oracle.yaml";

class Sweeps : public testing::Test {
 protected:
  SweepSetup read(const std::string& text) {
    return read_sweep(folder_.put("sweep.yaml", "base: " + kBase + "\nseeds: 10:14\n" + text));
  }
  /// Of the file, without the folder's name, or of the first cell that cannot be meant.
  std::string error_of(const std::string& text) {
    try {
      const SweepSetup sweep = read(text);
      for (std::size_t c = 0; c < sweep.plan.cells.size(); ++c) cell_scenario(sweep, c);
    } catch (const SpecError& error) {
      const std::string what = error.what();
      return what.rfind(folder_.at(""), 0) == 0 ? what.substr(folder_.at("").size()) : what;
    }
    return "no error";
  }
  TempFolder folder_;
};

TEST_F(Sweeps, AGridHoldsEveryCombinationOnTheSameSeeds) {
  const SweepSetup sweep = read(
      "name: small\nfactors:\n  count: [3, 5]\n  height: {field: 'cell.look.camera.xyz[2]', levels: {low: 555 mm, "
      "high: 605 mm}}\n"
      "  tool:\n    levels:\n      three: {cell.gripper.preset: three_cups}\n"
      "      four: {cell.gripper.preset: four_cups, cell.gripper.min_cups: 3}\n");
  ASSERT_EQ(sweep.plan.cells.size(), 8u);
  EXPECT_EQ(sweep.plan.first_seed, 10u);
  EXPECT_EQ(sweep.plan.end_seed, 14u);
  EXPECT_THAT(sweep.plan.cells[0].values, ElementsAre("3", "low", "three"));
  EXPECT_THAT(sweep.plan.cells[5].levels, ElementsAre(1, 0, 1));
  EXPECT_EQ(sweep.plan.cells[5].folder, "cells/5-low-four");
  EXPECT_THAT(sweep.plan.factors[2].fields, ElementsAre("cell.gripper.preset", "cell.gripper.min_cups"));
  const Scenario scenario = cell_scenario(sweep, 5);
  EXPECT_EQ(scenario.part_count(), 5);
  EXPECT_NEAR(scenario.cell.look.pose.translation().z(), 0.555, 1e-15);
  EXPECT_NEAR(scenario.cell.look.pose.translation().x(), 0.495, 1e-15);  // the cell file's own
  EXPECT_THAT(expanded_yaml(scenario, ""), HasSubstr("min_cups: 3"));
  EXPECT_EQ(scenario.name, "small: 5, low, four");
  std::set<std::string> hashes;
  for (std::size_t c = 0; c < 8; ++c) hashes.insert(scenario_hash(cell_scenario(sweep, c)));
  EXPECT_EQ(hashes.size(), 8u);
}

TEST_F(Sweeps, ACellIsTheSceneThatSaysTheSame) {
  const SweepSetup sweep =
      read("factors:\n  drop.height: [350 mm]\n  sensor: [{type: disparity, preset: d415_1280}]\n");
  Scenario cell = cell_scenario(sweep, 0);
  const std::string scene =
      folder_.put("scene.yaml", "name: ci_bearing_oracle\npart: " + std::string(BINPICK_SOURCE_DIR) +
                                    "/assets/parts/bearing_6914/part.yaml\ncount: 4\ncell: " + BINPICK_SOURCE_DIR +
                                    "/assets/cells/mz07_three_cups.yaml\nsensor: {type: disparity, preset: d415_1280}\n"
                                    "estimator: {type: oracle}\ntrial: {max_picks: 2}\ndrop: {height: 350 mm}\n");
  const Scenario written = read_scenario(scene);
  cell.name = written.name;
  EXPECT_EQ(scenario_hash(cell), scenario_hash(written));
}

TEST_F(Sweeps, ALatinHypercubeUsesEveryStratumOnce) {
  const std::string text =
      "design: latin_hypercube\npoints: 12\nseed: 5\nfactors:\n  drop.height: {range: [300 mm, 420 mm]}\n"
      "  exposure: {field: trial.exposure, range: [0.1, 0.7]}\n  count: {range: [2, 26], step: 2}\n"
      "  renderer: [osmesa, raycast]\n";
  const SweepSetup sweep = read(text);
  ASSERT_EQ(sweep.plan.cells.size(), 12u);
  std::set<int> heights, exposures;
  int raycast = 0;
  for (std::size_t c = 0; c < 12; ++c) {
    const std::vector<std::string>& values = sweep.plan.cells[c].values;
    const double height = parse_quantity(values[0], Unit::kLength), exposure = parse_quantity(values[1], Unit::kNone);
    heights.insert(static_cast<int>((height - 0.3) / 0.01));
    exposures.insert(static_cast<int>((exposure - 0.1) / 0.05));
    EXPECT_EQ(sweep.plan.cells[c].levels[0], static_cast<std::size_t>((height - 0.3) / 0.04)) << values[0];
    raycast += values[3] == "raycast" ? 1 : 0;
    const int count = std::stoi(values[2]);
    EXPECT_TRUE(count >= 2 && count <= 26 && count % 2 == 0) << values[2];
    EXPECT_EQ(cell_scenario(sweep, c).part_count(), count);
    EXPECT_DOUBLE_EQ(cell_scenario(sweep, c).drop.height, height);
  }
  EXPECT_EQ(heights.size(), 12u);
  EXPECT_EQ(*heights.begin(), 0);
  EXPECT_EQ(*heights.rbegin(), 11);
  EXPECT_EQ(exposures.size(), 12u);
  EXPECT_EQ(raycast, 6);
  EXPECT_THAT(sweep.plan.factors[0].levels, ElementsAre("300 .. 340 mm", "340 .. 380 mm", "380 .. 420 mm"));
  // Stated by its seed: the same again, another for another one.
  const SweepSetup again = read(text);
  std::string other = text;
  other.replace(other.find("seed: 5"), 7, "seed: 6");
  const SweepSetup third = read(other);
  int moved = 0;
  for (std::size_t c = 0; c < 12; ++c) {
    EXPECT_EQ(again.plan.cells[c].values, sweep.plan.cells[c].values);
    moved += third.plan.cells[c].values != sweep.plan.cells[c].values ? 1 : 0;
  }
  EXPECT_GT(moved, 6);
}

TEST_F(Sweeps, BadInputNamesFileLineAndField) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"factors:\n  cont: [3, 5]\n", "sweep.yaml:4: cont: unknown key, did you mean count?"},
      {"factors:\n  drop.height: [300 mm, 3 kg]\n", "sweep.yaml:4: drop.height: "},
      {"factors:\n  height:\n    field: drop.hight\n    levels: [300 mm]\n", "sweep.yaml:6: drop.hight: unknown key"},
      {"factors:\n  sensor: [{type: nonsense}]\n", "sweep.yaml:4: sensor.type: 'nonsense' is not known"},
      {"factors:\n  sensor.preset: [d435_848]\n", "sweep.yaml:4: sensor.preset: unknown key"},
      {"factors:\n  'cell.look.camera.xyz[5]': [1]\n", "has 3 items"},
      {"factors:\n  count: [3]\n  'cell.look.camera.xyz[2]':\n  - 605 mm\n  - 3 m\n",
       "sweep.yaml:7: cell.look.camera.xyz[2] = 3 m: " + kBase + ": cell.look.camera: the arm cannot reach this pose"},
      {"factors:\n  part: [nowhere.yaml]\n", "nowhere.yaml"},
      {"factors:\n  count: []\n", "sweep.yaml:4: count: has no level"},
      {"factors: {}\n", "sweep.yaml:3: factors: there is none"},
      {"factors:\n  count: [3, 3]\n", "sweep.yaml:4: count: the level '3' is there twice"},
      {"factors:\n  count: 3\n", "sweep.yaml:4: must be a mapping"},
      {"factors:\n  a: {levels: [1, 2]}\n", "a list of levels needs a `field`"},
      {"factors:\n  a: {field: count, levles: [1]}\n", "sweep.yaml:4: a.levles: unknown key, did you mean levels?"},
      {"factors:\n  a: {field: count}\n", "sweep.yaml:4: a: needs either levels or a range"},
      {"factors:\n  count: {range: [1, 5]}\n", "a range needs `design: latin_hypercube`"},
      {"factors:\n  count: [1]\n  more: {field: count, levels: [2]}\n", "sweep.yaml:5: more: count is set by count ("},
      {"factors:\n  sensor: [{type: ideal}]\n  sensor.preset: [x]\n", "sensor.preset is set by sensor ("},
      {"factors:\n  a: {levels: {x: {drop: {}, drop.height: 1}}}\n", "set the same"},
      {"design: grd\nfactors:\n  count: [1]\n", "sweep.yaml:3: design: 'grd' is not known, did you mean grid?"},
      {"points: 4\nfactors:\n  count: [1]\n", "sweep.yaml:3: points: belongs to `design: latin_hypercube`"},
      {"design: latin_hypercube\nfactors:\n  count: [1]\n", "points: a Latin hypercube needs 2 to"},
      {"design: latin_hypercube\npoints: 3\nfactors:\n  drop.height: {range: [1 mm, 1 m]}\n", "the same unit"},
      {"design: latin_hypercube\npoints: 3\nfactors:\n  drop.height: {range: [2, 1]}\n", "low end must lie below"},
      {"design: latin_hypercube\npoints: 3\nfactors:\n  count: {range: [a, 1]}\n", "is not a number"},
      {"design: latin_hypercube\npoints: 3\nfactors:\n  count: {range: [1, 2], step: -1}\n", "positive number"},
      {"design: latin_hypercube\npoints: 3\nfactors:\n  count: {range: [1, 9]}\n", "is not a whole number"},
      {"alpha: 2\nfactors:\n  count: [1]\n", "sweep.yaml:3: alpha: must lie between 0 and 1"},
      {"objective: speed\nfactors:\n  count: [1]\n", "objective: 'speed' is not known"},
      {"sede: 1\nfactors:\n  count: [1]\n", "sweep.yaml:3: sede: unknown key, did you mean seed?"},
      {"name: x\n", "factors: is missing"},
  };
  for (const auto& [text, message] : cases) EXPECT_THAT(error_of(text), HasSubstr(message)) << text;
  EXPECT_EQ(error_of("factors:\n  count: [1]\n"), "no error");
  folder_.put("s.yaml", "base: " + kBase + "\nseeds: 9:5\nfactors: {count: [1]}\n");
  EXPECT_THROW(read_sweep(folder_.at("s.yaml")), SpecError);
  folder_.put("s.yaml", "base: nowhere.yaml\nseeds: 5:9\nfactors: {count: [1]}\n");
  EXPECT_THROW(read_sweep(folder_.at("s.yaml")), SpecError);
}

TEST(SweepShards, EveryTrialBelongsToExactlyOneAndFewSeedsAreSpread) {
  constexpr int kShards = 16;
  std::vector<int> sizes(kShards + 1, 0);
  for (int cell = 0; cell < 40; ++cell) {
    const std::string folder = "cells/" + std::to_string(cell);
    std::vector<int> owners(10, 0);
    for (int shard = 1; shard <= kShards; ++shard)
      for (std::uint64_t seed = 0; seed < 10; ++seed)
        if (in_shard(seed, cell_shard(folder, shard, kShards), kShards)) {
          ++owners[seed];
          ++sizes[static_cast<std::size_t>(shard)];
        }
    EXPECT_THAT(owners, testing::Each(1)) << cell;
  }
  // 400 trials of ten seeds on 16 shards: 25 each in the mean; by the seed alone at most ten would have any.
  for (int shard = 1; shard <= kShards; ++shard) EXPECT_GT(sizes[static_cast<std::size_t>(shard)], 8) << shard;
}

}  // namespace
}  // namespace binpick

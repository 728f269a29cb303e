// binpick bench perception: heaps that are kept are the trial's heaps to the bit, figures known on paper,
// settings read strictly.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "tests/tools/few_parts.hpp"
#include "tests/tools/run_program.hpp"
#include "tools/bench/peers/peer.hpp"
#include "tools/bench/perception_ablation.hpp"
#include "tools/bench/perception_calibration.hpp"
#include "tools/bench/perception_heaps.hpp"
#include "tools/bench/perception_rows.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

/// A scene of a few parts, ready to drop.
struct FewTees {
  TemporaryFolder folder;
  Scenario scenario;
  TrialContext context;
  explicit FewTees(const std::string& sensor = "", int count = 3) {
    write_file(folder.path("scene.yaml"), scene_text(count));
    scenario = read_scenario(folder.path("scene.yaml"), {sensor});
    context = make_trial_context(scenario);
  }
  std::string store() const { return folder.path("heaps"); }
  std::string file(std::uint64_t seed) const {
    return store() + "/" + heap_key(scenario, context) + "/" + std::to_string(seed) + ".json";
  }
};

Observation look(FewTees& tees, const SettledHeap& heap, std::uint64_t seed) {
  CellWorld cell_world(tees.scenario.cell, tees.scenario.physics, tees.context.parts);
  place_heap(heap, cell_world);
  return observe(tees.scenario, cell_world, tees.context, Seed{seed}, 0);
}

TEST(PerceptionHeaps, AKeptHeapLooksLikeTheTrialsToTheBit) {
  FewTees tees;
  const std::uint64_t seed = 7;
  CellWorld cell_world(tees.scenario.cell, tees.scenario.physics, tees.context.parts);
  drop_heap(tees.scenario, tees.context, Seed{seed}, cell_world);
  const Observation direct = observe(tees.scenario, cell_world, tees.context, Seed{seed}, 0);

  HeapStore first(tees.store()), second(tees.store());
  const SettledHeap dropped = first.heap(tees.scenario, tees.context, seed);
  EXPECT_TRUE(second.heap(tees.scenario, tees.context, seed) == dropped);
  EXPECT_EQ(first.dropped(), 1);
  EXPECT_EQ(second.dropped(), 0) << "read from the folder";
  const Observation kept = look(tees, second.heap(tees.scenario, tees.context, seed), seed);

  EXPECT_EQ(kept.frame_hash, direct.frame_hash);
  ASSERT_EQ(kept.truth.instances.size(), direct.truth.instances.size());
  ASSERT_EQ(kept.truth.instances.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const GroundTruth::Instance &a = kept.truth.instances[i], &b = direct.truth.instances[i];
    EXPECT_EQ(a.X_WP.matrix(), b.X_WP.matrix());
    EXPECT_EQ(a.visible_pixels, b.visible_pixels);
    EXPECT_EQ(a.visible_fraction, b.visible_fraction);
    EXPECT_EQ(a.body, b.body);
  }
}

TEST(PerceptionHeaps, TheKeyFollowsThePhysicsAndNothingElse) {
  const FewTees tees, other_sensor("gauss_z:sigma_0.5mm"), more("", 4);
  FewTees heavier, higher;
  heavier.context.parts[0].mass.mass *= 2;
  higher.scenario.drop.height += 0.01;
  const std::string key = heap_key(tees.scenario, tees.context);
  EXPECT_EQ(heap_key(other_sensor.scenario, other_sensor.context), key);
  EXPECT_NE(heap_key(more.scenario, more.context), key);
  EXPECT_NE(heap_key(heavier.scenario, heavier.context), key);
  EXPECT_NE(heap_key(higher.scenario, higher.context), key);
}

TEST(PerceptionHeaps, AFileThatDoesNotFitIsMadeAnew) {
  FewTees tees("", 1);
  HeapStore store(tees.store());
  const SettledHeap heap = store.heap(tees.scenario, tees.context, 1);
  const std::string text = read_file(tees.file(1));
  std::string moved = text;
  const std::size_t digit = moved.find("0.", moved.find("X_WP")) + 4;
  moved[digit] = moved[digit] == '1' ? '2' : '1';
  for (const std::string& bad : {std::string("{"), std::string("[1, 2]"), moved, text.substr(0, text.size() / 2)}) {
    write_file(tees.file(1), bad);
    HeapStore again(tees.store());
    EXPECT_TRUE(again.heap(tees.scenario, tees.context, 1) == heap);
    EXPECT_EQ(again.dropped(), 1);
    EXPECT_EQ(read_file(tees.file(1)), text);
  }
  HeapStore other_seed(tees.store());
  std::filesystem::copy_file(tees.file(1), tees.file(2));
  EXPECT_FALSE(other_seed.heap(tees.scenario, tees.context, 2) == heap) << "a heap of another seed was believed";
}

/// A row of looks without a scene.
PerceptionRow row_of(std::vector<LookScore> looks) {
  PerceptionRow row;
  row.looks = std::move(looks);
  row.times.resize(row.looks.size());
  return row;
}

TEST(PerceptionFigures, PoolWhatTheLooksSay) {
  LookScore a, b;
  a.recall = {3, 4}, a.precision = {3, 3}, a.top1 = true;
  a.right = {{0.001, 0.0006, -0.0008, 0.01}, {0.002, 0, 0.002, 0.02}};
  b.recall = {5, 5}, b.precision = {5, 7}, b.top1 = false, b.top1_in_clear_view = false;
  b.right = {{0.003, 0, 0.003, 0.03}};
  PerceptionRow row = row_of({a, b});
  row.times[0].total = 10, row.times[1].total = 30;
  const RowFigures f = figures_of(row);
  EXPECT_DOUBLE_EQ(f.recall.rate, 8.0 / 9);
  EXPECT_EQ(f.recall.hits, 8u);
  EXPECT_DOUBLE_EQ(f.precision.rate, 0.8);
  EXPECT_LE(f.precision.interval.low, 0.8);
  EXPECT_GE(f.precision.interval.high, 0.8);
  EXPECT_EQ(f.top1.hits, 1u);
  EXPECT_EQ(f.top1.total, 2u);
  EXPECT_EQ(f.top1_clear.total, 1u) << "an ambiguous first answer is scored apart";
  EXPECT_DOUBLE_EQ(f.translation_median, 0.002);
  EXPECT_DOUBLE_EQ(f.z_bias, 0.002) << "signed";
  EXPECT_DOUBLE_EQ(f.abs_z_median, 0.002);
  EXPECT_DOUBLE_EQ(f.median.total, 20);
  EXPECT_TRUE(std::isnan(f.median.first));
}

TEST(PerceptionFigures, APeersRatioComparesTheSameHeapsOnly) {
  LookScore one, two, three;
  one.seed = 1, two.seed = 2, three.seed = 3;
  PerceptionRow ours = row_of({one, two, three}), peer = row_of({two});
  ours.times[0].total = 1, ours.times[1].total = 10, ours.times[2].total = 100;
  peer.times[0].total = 500;
  EXPECT_DOUBLE_EQ(time_ratio(peer, ours), 50);
}

TEST(PerceptionCalibration, CountsTheShareOfRightOnesInEachBin) {
  std::vector<ScoredEstimate> estimates;
  for (int k = 0; k < 10; ++k) estimates.push_back({0.95, k < 9});
  for (int k = 0; k < 4; ++k) estimates.push_back({0.25, k < 1});
  estimates.push_back({1.0, true});
  const std::vector<ReliabilityBin> bins = reliability(estimates, 10);
  ASSERT_EQ(bins.size(), 2u);
  EXPECT_EQ(bins[0].right, 1u);
  EXPECT_EQ(bins[0].total, 4u);
  EXPECT_EQ(bins[1].right, 10u);
  EXPECT_EQ(bins[1].total, 11u) << "a score of 1 belongs to the last bin";
  EXPECT_NEAR(calibration_error(bins), std::abs(0.95 * 10 + 1 - 10) / 15, 1e-12)
      << "0.25 is right a quarter of the time";
}

TEST(PerceptionAblation, EveryVariantIsASetOfSettingsThatExist) {
  const std::vector<ContenderSpec> variants = ablation_variants();
  EXPECT_GE(variants.size(), 5u);
  const std::string full = Contender(variants.front()).settings();
  for (const ContenderSpec& spec : variants) {
    const Contender contender(spec);
    EXPECT_EQ(&spec == &variants.front(), contender.settings() == full) << spec.name;
  }
}

TEST(PerceptionContender, SettingsAreReadStrictly) {
  EXPECT_THROW(Contender(parse_contender("ppff")), SpecError);
  EXPECT_THROW(Contender(parse_contender("ppf search.edgse=false")), SpecError);
  EXPECT_THROW(Contender(parse_contender("ppf search.rounds=0")), SpecError);
  EXPECT_THROW(Contender(parse_contender("ppf search.rounds")), SpecError);
  EXPECT_THAT(Contender(parse_contender("ppf search.rounds=7")).settings(), HasSubstr("rounds: 7"));
  EXPECT_TRUE(Contender(parse_contender("oracle min_visible=0.4")).reads_truth());
}

TEST(PerceptionView, TroublesAreAsLargeAsStated) {
  SceneView view;
  view.seen = PointCloud{};
  view.bin = BinSpec{};
  view.X_CB = pose_from_xyz_rpy({0.1, 0.2, 0.6}, {3, 0.1, 0});
  ViewTrouble trouble;
  trouble.bin_offset = 0.005;
  trouble.bin_turn = 0.0175;
  const Pose off = view.X_CB.inverse() * troubled(view, trouble, Seed{3}).X_CB;
  EXPECT_NEAR(off.translation().norm(), 0.005, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(off.linear()).angle(), 0.0175, 1e-9);
  EXPECT_NE(troubled(view, trouble, Seed{4}).X_CB.matrix(), troubled(view, trouble, Seed{3}).X_CB.matrix());
  trouble = {};
  trouble.no_bin = true;
  EXPECT_FALSE(troubled(view, trouble, Seed{3}).bin.has_value());
}

TEST(PerceptionBench, SensorNamesMayBeShort) {
  EXPECT_EQ(full_sensor_name("gauss_0.5mm"), "gauss_z:sigma_0.5mm");
  EXPECT_EQ(full_sensor_name("d435_848_out_of_box"), "disparity:d435_848_out_of_box");
  EXPECT_EQ(full_sensor_name("active_stereo:d435_848"), "active_stereo:d435_848");
  EXPECT_EQ(full_sensor_name("ideal"), "ideal");
  EXPECT_THROW(full_sensor_name("d999"), SpecError);
}

}  // namespace
}  // namespace binpick

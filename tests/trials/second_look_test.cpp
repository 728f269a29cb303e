// When the arm looks again, what it then sees, and what the record says about it.
#include "trials/second_look.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/yaml.hpp"
#include "trials/trial.hpp"

namespace binpick {
namespace {

const std::string kScenes = std::string(BINPICK_SOURCE_DIR) + "/scenes/";

struct Loaded {
  Scenario scenario;
  TrialContext context;
};

std::unique_ptr<Loaded> load(const std::string& scene) {
  auto made = std::make_unique<Loaded>();
  made->scenario = read_scenario(kScenes + scene);
  made->scenario.parts[0].count = 4;
  made->scenario.trial.max_picks = 1;
  made->context = make_trial_context(made->scenario);
  return made;
}

Loaded& oracle_scene() {
  static const std::unique_ptr<Loaded> loaded = load("bearing_bin_oracle.yaml");
  return *loaded;
}

/// One estimate in the middle of the bin and a plan for it.
struct Known {
  Scenario& s = oracle_scene().scenario;
  std::vector<Part>& parts = oracle_scene().context.parts;
  Sight sight;
  SecondLookConfig config;
  std::vector<Eigen::Vector3d> failed_W;
  Known() {
    config.when = {"no_plan", "poor_fit", "failed"};
    sight.seen.X_WC_believed = s.cell.camera_pose(s.cell.q_look);
    sight.found.status = EstimateStatus::kFound;
    PoseEstimate estimate;
    estimate.X_CP = sight.seen.X_WC_believed.inverse() * s.cell.X_WB;
    estimate.score = 0.995;
    sight.found.estimates = {estimate};
    sight.plan.plan.emplace();
    sight.plan.plan->X_WP_est = s.cell.X_WB;
    sight.plan.plan->X_WG = s.cell.X_WB * pose_from_xyz_rpy({0, 0, 0.016}, {3.14159265, 0, 0});
  }
  std::string why() const { return why_look_again(config, sight, s.cell, parts, failed_W); }
};

TEST(WhyLookAgain, NotWhenThePickIsSureAndNew) {
  Known known;
  known.failed_W = {known.s.cell.X_WB * Eigen::Vector3d(0.1, 0, 0)};  // another part's place
  EXPECT_EQ(known.why(), "");
}

TEST(WhyLookAgain, ForALowScoreOrLipsThatAreNotKnownWell) {
  Known known;
  known.sight.found.estimates[0].score = 0.89;
  EXPECT_EQ(known.why(), "poor fit: score 0.890");
  known.sight.found.estimates[0].score = 0.995;
  known.sight.found.estimates[0].covariance(2, 2) = 4e-6;
  EXPECT_EQ(known.why(), "poor fit: the lips' place is known to 2.0 mm");
  known.config.deviation = 0.0021;
  EXPECT_EQ(known.why(), "");
  known.config.deviation = 0.001;
  known.config.when = {"no_plan", "failed"};
  EXPECT_EQ(known.why(), "");
}

TEST(WhyLookAgain, WhenAPickOfThePartHasFailed) {
  Known known;
  known.failed_W = {known.s.cell.X_WB * known.parts[0].box_center_P + Eigen::Vector3d(0.01, 0, 0)};
  EXPECT_EQ(known.why(), "a pick of it has failed");
  known.config.when = {"no_plan", "poor_fit"};
  EXPECT_EQ(known.why(), "");
}

TEST(WhyLookAgain, WhenThereIsNoPlan) {
  Known known;
  known.sight.plan.plan.reset();
  EXPECT_EQ(known.why(), "no candidate survived");
  known.sight.found.estimates.clear();
  known.sight.found.status = EstimateStatus::kNothingFound;
  EXPECT_EQ(known.why(), "nothing was found");
  known.config.when = {"poor_fit", "failed"};
  EXPECT_EQ(known.why(), "");
  known.config.when = {"no_plan"};
  known.sight.found.status = EstimateStatus::kFailed;  // a program that fails is not asked again
  EXPECT_EQ(known.why(), "");
}

TEST(LookRequest, AimsAtThePartToBePickedOrElseTheHighestOfWhatWasSeen) {
  Known known;
  const ObstacleMap heap({{0.5, 0.02, 0.03}, {0.52, 0.04, 0.04}, {0.4, 0, 0.001}});
  auto request = look_request(known.s, known.sight, known.parts, heap);
  ASSERT_TRUE(request.has_value());
  EXPECT_LT((request->aim_W - known.s.cell.X_WB * known.parts[0].box_center_P).norm(), 1e-9);
  EXPECT_LT((request->normal_W - Eigen::Vector3d::UnitZ()).norm(), 1e-6);
  EXPECT_EQ(request->distance, 0.3);
  const std::shared_ptr<SensorModel> near = known.s.sensor;
  known.s.sensor = make_sensor("disparity");
  read_yaml_text("preset: d415_1280", "test", "", [&](ConfigVisitor& v) { known.s.sensor->visit(v); });
  request = look_request(known.s, known.sight, known.parts, heap);
  EXPECT_NEAR(request->distance, 0.402 + known.parts[0].diameter / 2, 1e-12);  // this camera is blind below 402 mm
  known.s.sensor = near;
  known.sight.plan.plan.reset();
  known.sight.found.estimates.clear();
  request = look_request(known.s, known.sight, known.parts, heap);
  ASSERT_TRUE(request.has_value());
  EXPECT_LT((request->aim_W - Eigen::Vector3d(0.51, 0.03, 0.035)).norm(), 1e-9);
  EXPECT_FALSE(look_request(known.s, known.sight, known.parts, ObstacleMap()).has_value());
}

TEST(SecondLook, TheRecordSaysWhyAndWhatItCost) {
  const std::unique_ptr<Loaded> scene = load("bearing_bin.yaml");
  EXPECT_EQ(scene->scenario.second_look.when, (std::vector<std::string>{"poor_fit", "failed"}));  // the default
  scene->scenario.second_look.when.clear();
  const TrialRecord once = run_trial(scene->scenario, Seed{3}, scene->context);
  EXPECT_EQ(once.picks.at(0).second_look, "");
  EXPECT_EQ(once.picks.at(0).look_time, 0);
  Scenario& twice = scene->scenario;
  twice.second_look.when = {"poor_fit"};
  twice.second_look.score = 1;  // a probability below one: no fit is good enough
  for (const char* from : {"above", "side"}) {
    twice.second_look.from = from;
    const TrialRecord record = run_trial(twice, Seed{3}, scene->context);
    ASSERT_TRUE(record.error.empty()) << record.error;
    const PickRecord& pick = record.picks.at(0);
    EXPECT_EQ(pick.second_look.rfind("poor fit: score ", 0), 0u) << pick.second_look;
    EXPECT_EQ(pick.second_look.find(';'), std::string::npos) << pick.second_look;  // it was taken
    EXPECT_EQ(pick.outcome, PickOutcome::kSucceeded) << pick.reason;
    EXPECT_EQ(pick.check.right, pick.check.counted);
    EXPECT_GT(pick.look_time, twice.trial.exposure + 0.2);
    EXPECT_NE(once.picks.at(0).frame_hash, pick.frame_hash);
    if (twice.second_look.from == "side") continue;
    EXPECT_EQ(record_hash(record), record_hash(run_trial(twice, Seed{3}, scene->context))) << "repeatable";
  }
}

/// A heap of the oracle scene, seen from the look pose and from over its first part.
struct TwoLooks {
  Seed seed;
  Scenario scenario = oracle_scene().scenario;
  TrialContext& context = oracle_scene().context;
  CellWorld cell_world{scenario.cell, scenario.physics, context.parts};
  Sight sight;
  PickRecord record;
  LookRun run() { return {scenario, cell_world, context, seed, 0, {}, failed_W}; }
  std::vector<Eigen::Vector3d> failed_W;  ///< the reason to look again: the part that would be picked
  explicit TwoLooks(std::uint64_t number = 3) : seed{number} {
    scenario.second_look.when = {"failed"};
    drop_heap(scenario, context, seed, cell_world);
    sight.seen = observe(scenario, cell_world, context, seed, 0);
    sight.found = estimate_view(scenario, context, sight.seen.view, sight.seen.truth, Seed{4});
    plan_sight(scenario, context, {}, sight, record);
    const PickPlan& plan = sight.plan.plan.value();
    failed_W = {plan.X_WP_est * context.parts[0].box_center_P};
  }
  /// The faces of the first part look up: from over it the second look then sees all that the first one saw of it.
  bool flat() const { return std::abs(sight.plan.plan->X_WP_est.linear()(2, 2)) > 0.8; }
};

std::unique_ptr<TwoLooks> looks_at_a_flat_part() {
  for (std::uint64_t seed = 3;; ++seed)
    if (auto looks = std::make_unique<TwoLooks>(seed); looks->flat()) return looks;
}

TEST(SecondLook, TheViewHoldsTheFramesOfBothLooks) {
  const auto made = looks_at_a_flat_part();
  TwoLooks& looks = *made;
  const Sight first = looks.sight;
  ASSERT_TRUE(look_again(looks.run(), looks.sight, looks.record));
  const Observation& both = looks.sight.seen;
  ASSERT_EQ(both.captures.size(), 2u);
  EXPECT_EQ(both.X_WC_believed.matrix(), both.captures[1].frame.X_WC.matrix());  // in the C of the second
  EXPECT_EQ(both.truth.X_WC.matrix(), both.captures[1].frame.X_WC.matrix());
  // About the part the second look counts alone; elsewhere what only the first one saw is there as well.
  const auto returns = [&](const PointCloud& cloud, const Pose& X_WK, double radius) {
    const Eigen::Vector3d aim_K = X_WK.inverse() * looks.failed_W[0];
    return std::count_if(cloud.points.begin(), cloud.points.end(),
                         [&](const Eigen::Vector3d& p_K) { return (p_K - aim_K).norm() < radius; });
  };
  std::vector<PointCloud> clouds;
  for (const Capture& capture : both.captures) clouds.push_back(unproject(capture.frame));
  const auto& cloud = std::get<PointCloud>(both.view.seen);
  const Pose& X_WC = first.seen.X_WC_believed;
  const auto near = returns(clouds[1], both.X_WC_believed, 0.04), far = returns(clouds[0], X_WC, 0.04);
  EXPECT_GT(far, near / 10);
  EXPECT_LT(static_cast<double>(returns(cloud, both.X_WC_believed, 0.04)), 1.03 * static_cast<double>(near));
  EXPECT_GT(returns(cloud, both.X_WC_believed, 1), returns(clouds[1], both.X_WC_believed, 1) + 10000);
  const Eigen::Vector3d p_WC = both.captures[1].frame.X_WC.translation();
  EXPECT_LT(p_WC.z(), first.seen.X_WC_believed.translation().z() - 0.1);
  ASSERT_TRUE(looks.sight.plan.plan.has_value());
  const Vector6d& q = looks.sight.plan.plan->approach.q.front();
  EXPECT_EQ(q, looks.cell_world.joints()) << "the pick starts from where the arm stands";
  for (std::size_t i = 0; i < both.truth.instances.size(); ++i)
    EXPECT_GE(both.truth.instances[i].visible_fraction, first.seen.truth.instances[i].visible_fraction);
}

TEST(SecondLook, WhenNothingIsPickedTheArmReturns) {
  TwoLooks looks;
  const LookRun run = looks.run();
  ASSERT_TRUE(look_again(run, looks.sight, looks.record));
  const double there = looks.record.look_time;
  EXPECT_GT((looks.cell_world.joints() - looks.scenario.cell.q_look).norm(), 0.1);
  return_home(run, looks.record);
  EXPECT_LT((looks.cell_world.joints() - looks.scenario.cell.q_look).norm(), 1e-9);
  EXPECT_NEAR(looks.record.look_time, 2 * there - looks.scenario.trial.exposure, 1e-9);  // the same way back
  EXPECT_NEAR(looks.record.motion_time, looks.record.look_time - looks.scenario.trial.exposure, 1e-9);
  EXPECT_TRUE(looks.record.collisions.empty());
}

TEST(SecondLook, ScenesSayOffOrWhen) {
  const std::string folder = testing::TempDir(), path = folder + "second_look.yaml";
  const auto scene = [&](const std::string& more) {
    write_file(path, "part: " + kScenes + "../assets/parts/bearing_6914/part.yaml\ncell: {base: " + kScenes +
                         "../assets/cells/mz07_three_cups.yaml" +
                         (more.find("fixed") == 0 ? ", camera: {mount: fixed, pose: {xyz: [0.495, 0, 0.605], rpy: [180 "
                                                    "deg, 0, 0]}}, look: {joints: [0, 0, 0, 0, 90 deg, 0]}"
                                                  : "") +
                         "}\n" + (more.find("fixed") == 0 ? more.substr(6) : more) + "\n");
    return read_scenario(path);
  };
  EXPECT_TRUE(scene("second_look: off").second_look.when.empty());
  EXPECT_EQ(scene("second_look: {when: [failed], from: side}").second_look.from, "side");
  EXPECT_EQ(scene("second_look: {from: side}").second_look.when.size(), 2u);
  EXPECT_TRUE(scene("estimator: {type: oracle}").second_look.when.empty());  // its score is no probability
  EXPECT_TRUE(scene("fixed ").second_look.when.empty());
  EXPECT_THROW(scene("second_look: on"), SpecError);
  EXPECT_THROW(scene("second_look: {when: [bored]}"), SpecError);
  try {
    scene("fixed second_look: {when: [no_plan]}");
    FAIL() << "a fixed camera cannot look again";
  } catch (const SpecError& error) {
    EXPECT_NE(std::string(error.what()).find("second_look.when: the camera is fixed"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace binpick

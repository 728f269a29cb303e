// `calibration:` of a scene: the cell believes its camera to be elsewhere than it is, and everything downstream with
// it.
#include "trials/calibration/calibration_config.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "trials/calibration/calibration_trial.hpp"
#include "trials/observation.hpp"
#include "trials/trial.hpp"

namespace binpick {
namespace {

const std::string kScenes = std::string(BINPICK_SOURCE_DIR) + "/scenes/";
const std::string kOffset = "calibration: {offset: {translation: [2 mm, -1 mm, 3 mm], rotation: [0, 0, 0.5 deg]}}";

/// Two bearings seen without noise and found from the truth, with one more line.
Scenario scene_with(const std::string& line) {
  const std::string path = testing::TempDir() + "calibrated.yaml";
  write_file(path, "name: calibrated\npart: " + kScenes + "../assets/parts/bearing_6914/part.yaml\ncount: 2\ncell: " +
                       kScenes + "../assets/cells/mz07_three_cups.yaml\nsensor: {type: ideal}\n" +
                       "estimator: {type: oracle}\ntrial: {max_picks: 1}\n" + line + "\n");
  return read_scenario(path);
}

std::string refusal(const std::string& line) {
  try {
    Scenario scenario = scene_with(line);
    make_trial_context(scenario);
  } catch (const SpecError& error) {
    return error.what();
  }
  return "accepted";
}

Pose offset_of(const TrialRecord& record) {
  return pose_from(exp_so3(record.calibration_rotation.value()), record.calibration_translation.value());
}

TEST(CalibrationConfig, TheOffsetIsInTheBeliefAndNotInTheTruth) {
  Scenario scenario = scene_with(kOffset);
  TrialContext context = make_trial_context(scenario);
  const Pose X_CC = pose_from_xyz_rpy({2e-3, -1e-3, 3e-3}, {0, 0, 0.5 * M_PI / 180});
  const TrueCell built = true_cell(scenario, context, Seed{3});
  CellWorld cell_world(built.cell, scenario.physics, context.parts);
  drop_heap(scenario, context, Seed{3}, cell_world);
  const Observation seen = observe(scenario, cell_world, context, Seed{3}, 0);
  const Pose X_WC_drawn = scenario.cell.camera_pose(scenario.cell.q_look);
  EXPECT_LT(distance_between(seen.X_WC_believed, X_WC_drawn), 1e-12);
  EXPECT_LT(log_se3((seen.truth.X_WC * X_CC).inverse() * seen.X_WC_believed).norm(), 1e-9);
  EXPECT_LT(log_se3((seen.X_WC_believed * seen.view.X_CB).inverse() * scenario.cell.X_WB).norm(), 1e-9);
  // The frame is taken from where the camera is: another one than that of a camera that is where it should be.
  scenario.calibration = {};
  CellWorld drawn(scenario.cell, scenario.physics, context.parts);
  drop_heap(scenario, context, Seed{3}, drawn);
  EXPECT_NE(observe(scenario, drawn, context, Seed{3}, 0).frame_hash, seen.frame_hash);
  // And for a second look.
  const Capture again = capture_again(scenario, cell_world, context, Seed{3}, 0);
  EXPECT_EQ(again.frame.X_WC.matrix(), seen.X_WC_believed.matrix());
}

TEST(CalibrationConfig, APoseIsOffByAsMuchAndTheRecordSaysSo) {
  Scenario scenario = scene_with("calibration: {offset: {translation: [3 mm, 4 mm, 0]}, scale: 2}");
  scenario.second_look.score = 2;  // no fit is good enough
  TrialContext context = make_trial_context(scenario);
  TrialRecord record;
  for (const bool twice : {false, true}) {
    if (twice) scenario.second_look.when = {"poor_fit"};
    record = run_trial(scenario, Seed{3}, context);
    ASSERT_TRUE(record.error.empty()) << record.error;
    EXPECT_EQ(record.picks.at(0).look_time > 0, twice) << record.picks[0].second_look;
    EXPECT_LT((offset_of(record).translation() - Eigen::Vector3d(6e-3, 8e-3, 0)).norm(), 1e-12);
    ASSERT_FALSE(record.picks[0].check.estimates.empty());
    for (const MatchedEstimate& match : record.picks[0].check.estimates)
      EXPECT_NEAR(match.error.translation, 0.01, 1e-9) << "second look: " << twice;
  }
  EXPECT_EQ(record_hash(record), record_hash(trial_record_from_json(to_json_line(record), "line")));
}

TEST(CalibrationConfig, ATrialsCalibrationIsTheOneOfItsSeed) {
  Scenario scenario = scene_with("calibration: chain");
  TrialContext context = make_trial_context(scenario);
  const CalibrationSetup setup = calibration_setup(scenario.cell, {15});
  const auto measured = [&](std::uint64_t seed) {
    return calibration_error(setup, {}, CalibrationMethod::kChain, Seed{seed}).X_CC;
  };
  const Pose X_CC = true_cell(scenario, context, Seed{7}).X_CC.value();
  EXPECT_LT(log_se3(X_CC.inverse() * measured(7)).norm(), 1e-12);
  EXPECT_GT(log_se3(X_CC.inverse() * measured(8)).norm(), 1e-4);
  scenario.calibration.scale = 2;
  const Pose X_CC_twice = true_cell(scenario, context, Seed{7}).X_CC.value();
  EXPECT_LT((log_se3(X_CC_twice) - 2 * log_se3(X_CC)).norm(), 1e-9);
  scenario.calibration = {};
  scenario.calibration.method = "hand_eye";
  context.calibration = std::make_shared<const CalibrationSetup>(setup);
  const CalibrationError park = calibration_error(setup, {}, CalibrationMethod::kPark, Seed{7});
  EXPECT_LT(log_se3(true_cell(scenario, context, Seed{7}).X_CC->inverse() * park.X_CC).norm(), 1e-12);
}

TEST(CalibrationConfig, StoredScenesReplayAndPerfectOnesAreAsBefore) {
  const auto stored = [](const Scenario& s) { return expanded_yaml(s, testing::TempDir()); };
  for (const std::string line :
       {"calibration: chain", "calibration: {method: hand_eye, poses: 7, scale: 0.1}",
        "calibration: {method: chain, errors: {corner: 0.5, plate_shift: 1 mm}}", kOffset.c_str()}) {
    const Scenario scenario = scene_with(line);
    const std::string text = stored(scenario), path = testing::TempDir() + "calibrated_again.yaml";
    write_file(path, text);
    const Scenario again = read_scenario(path);
    EXPECT_EQ(stored(again), text);
    EXPECT_EQ(scenario_hash(again), scenario_hash(scenario));
    EXPECT_NE(scenario_hash(scenario), scenario_hash(scene_with("")));
    EXPECT_EQ(again.calibration.scale, scenario.calibration.scale);
    EXPECT_EQ(again.calibration.translation, scenario.calibration.translation);
    EXPECT_EQ(again.calibration.errors.corner, scenario.calibration.errors.corner);
  }
  EXPECT_EQ(stored(scene_with("calibration: perfect")), stored(scene_with("")));
  EXPECT_EQ(stored(scene_with("")).find("calibration"), std::string::npos);
}

TEST(CalibrationConfig, WhatCannotBeMeantIsRefusedWithItsPlace) {
  const auto names = [](const std::string& line, std::initializer_list<const char*> words) {
    const std::string message = refusal(line);
    for (const char* word : words)
      EXPECT_NE(message.find(word), std::string::npos) << line << " gave: " << message << ", without " << word;
    EXPECT_NE(message.find("calibrated.yaml"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  names("calibration: chian", {"calibrated.yaml:8", "calibration", "chain"});
  names("calibration: {method: tsai}", {"calibration.method", "hand_eye"});
  names("calibration: {scale: 2}", {"calibration.method", "missing"});
  names("calibration: {method: chain, scale: -1}", {"calibrated.yaml:8", "scale", "between 0 and 20"});
  names("calibration: {method: chain, poses: 9}", {"calibration.poses", "unknown key"});
  names("calibration: {method: hand_eye, poses: 2}", {"poses", "between 3 and 100"});
  names("calibration: {offset: {translation: [2, 0, 0]}}", {"offset.translation", "metres"});
  names("calibration: {offset: {rotation: [0, 0, 2]}}", {"offset.rotation", "radians"});
  names("calibration: {method: chain, offset: {}}", {"calibration.offset", "leave out method"});
  names("calibration: {method: chain, errors: {focal: 0.5}}", {"focal", "below 0.1"});
  names("calibration: {method: chain, errors: {disparity_bias: 1}}", {"errors.disparity_bias", "unknown key"});
}

TEST(CalibrationConfig, OnlyACameraOnTheFlangeHasAChain) {
  const auto fixed = [](const std::string& calibration) {
    const std::string path = testing::TempDir() + "calibrated_fixed.yaml";
    write_file(path, "part: " + kScenes + "../assets/parts/bearing_6914/part.yaml\ncell: {base: " + kScenes +
                         "../assets/cells/mz07_three_cups.yaml, camera: {mount: fixed, pose: {xyz: [0.495, 0, 0.605], "
                         "rpy: [180 deg, 0, 0]}}, look: {joints: [0, 0, 0, 0, 90 deg, 0]}}\n" +
                         calibration + "\n");
    return read_scenario(path);
  };
  EXPECT_THROW(fixed("calibration: chain"), SpecError);
  Scenario scenario = fixed("calibration: {offset: {translation: [0, 0, 5 mm]}}");
  const TrueCell built = true_cell(scenario, {}, Seed{1});
  EXPECT_NEAR(built.cell.camera_pose(scenario.cell.q_look).translation().z(), 0.61, 1e-12);
}

}  // namespace
}  // namespace binpick

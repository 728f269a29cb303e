#include "robot/look_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/yaml.hpp"
#include "robot/collision_check.hpp"
#include "robot_fixture.hpp"

namespace binpick {
namespace {

using namespace testing_robot;

const Eigen::Vector3d kInBin(0.03, -0.05, 0.02);  // of the bin

LookRequest request_at(const Cell& cell, const Eigen::Vector3d& p_B, const std::string& from) {
  LookRequest request;
  request.aim_W = cell.X_WB * p_B;
  request.from = from;
  return request;
}

/// Free along the whole way, from the look pose, and the camera's axis meets the aim at the stated distance.
void expect_looks_at(const Cell& cell, const LookPlan& plan, const LookRequest& request) {
  const CollisionCheck check(cell, 0);
  EXPECT_EQ(plan.there.q.front(), cell.q_look);
  EXPECT_EQ(plan.there.q.back(), plan.q);
  EXPECT_EQ(check.path_hit(plan.there, 0.005, true), Obstacle::kNone);
  const Eigen::Vector3d aim_C = cell.camera_pose(plan.q).inverse() * request.aim_W;
  EXPECT_LT((aim_C - Eigen::Vector3d(0, 0, plan.distance)).norm(), 1e-6);
}

TEST(LookPose, FromAboveTheCameraStandsStraightOverThePart) {
  const Cell cell = cell_named("mz07_three_cups");
  const LookRequest request = request_at(cell, kInBin, "above");
  const auto plan = plan_look(cell, request, ObstacleMap());
  ASSERT_TRUE(plan.has_value());
  expect_looks_at(cell, *plan, request);
  EXPECT_EQ(plan->distance, 0.3);
  EXPECT_LT((cell.camera_pose(plan->q).linear().col(2) + Eigen::Vector3d::UnitZ()).norm(), 1e-6);
}

TEST(LookPose, FromASideItTiltsTowardsTheSideThatThePartFaces) {
  const Cell cell = cell_named("mz07_three_cups");
  for (const double angle : {0.0, 2.0, 4.0}) {
    LookRequest request = request_at(cell, {0, 0, 0.05}, "side");
    request.normal_W = {0.6 * std::cos(angle), 0.6 * std::sin(angle), 0.8};
    const auto plan = plan_look(cell, request, ObstacleMap());
    ASSERT_TRUE(plan.has_value()) << angle;
    expect_looks_at(cell, *plan, request);
    const Eigen::Vector3d towards_W = -cell.camera_pose(plan->q).linear().col(2);
    EXPECT_NEAR(towards_W.z(), std::cos(request.tilt), 1e-6);
    const double apart = std::acos(towards_W.head<2>().normalized().dot(request.normal_W.head<2>().normalized()));
    EXPECT_LT(apart, std::numbers::pi / 12 + 1e-6) << angle;  // half a step, all sides being free
  }
}

TEST(LookPose, AWallInTheSightIsLookedOver) {
  const Cell cell = cell_named("mz07_three_cups");
  // On the floor by the wall at -y and facing it: from there the wall would be in the way.
  LookRequest request = request_at(cell, {0, -0.17, 0.01}, "side");
  request.normal_W = {0, -1, 0};
  const auto plan = plan_look(cell, request, ObstacleMap());
  ASSERT_TRUE(plan.has_value());
  expect_looks_at(cell, *plan, request);
  const Eigen::Vector3d camera_B = cell.X_WB.inverse() * cell.camera_pose(plan->q).translation();
  const Eigen::Vector3d aim_B = cell.X_WB.inverse() * request.aim_W;
  const Eigen::Vector3d at_rim =
      aim_B + (camera_B - aim_B) * (cell.bin.inner_size.z() - aim_B.z()) / (camera_B - aim_B).z();
  EXPECT_GT(at_rim.y(), -cell.bin.inner_size.y() / 2);
}

TEST(LookPose, WhatIsSeenInTheWayMovesTheCameraOff) {
  const Cell cell = cell_named("mz07_three_cups");
  const LookRequest request = request_at(cell, kInBin, "above");
  const Pose X_WC = cell.camera_pose(plan_look(cell, request, ObstacleMap())->q);
  // A plate of points where the camera would stand.
  std::vector<Eigen::Vector3d> points_W;
  for (double x = -0.06; x <= 0.06; x += 0.005)
    for (double y = -0.06; y <= 0.06; y += 0.005) points_W.push_back(X_WC.translation() + Eigen::Vector3d(x, y, 0.01));
  const ObstacleMap heap(points_W);
  const auto plan = plan_look(cell, request, heap);
  ASSERT_TRUE(plan.has_value());
  EXPECT_GT(plan->distance, 0.3);
  expect_looks_at(cell, *plan, request);
}

TEST(LookPose, OutOfReachThereIsNone) {
  const Cell cell = cell_named("mz07_three_cups");
  EXPECT_FALSE(plan_look(cell, request_at(cell, {2, 0, 0}, "above"), ObstacleMap()).has_value());
}

/// A pick of the bearing lying flat in front of a camera that looks straight down, and its estimate.
struct FlatPick {
  Cell cell = cell_named("mz07_three_cups");
  Part part = load_part(read_part_spec(asset("parts/bearing_6914/part.yaml")));
  Pose X_WC = cell.camera_pose(cell.q_look);
  PickPlan plan;
  PoseEstimate estimate;
  FlatPick() {
    const Pose X_WP = cell.X_WB * pose_from_xyz_rpy({0, 0, 0.008}, {0, 0, 0.4});
    estimate.X_CP = X_WC.inverse() * X_WP;
    plan.X_WP_est = X_WP * pose_from_xyz_rpy({0, 0, 0}, {0, 0, 1.1});  // a twin
    plan.X_WG = X_WP * pose_from_xyz_rpy({0, 0, 0.008}, {std::numbers::pi, 0, 0});
    plan.site.cup = -1;
  }
  double deviation() const { return lip_deviation(estimate, X_WC, plan, part, *cell.gripper); }
};

TEST(LipDeviation, IsWhatTheCovarianceMovesTheLipsBy) {
  FlatPick pick;
  EXPECT_EQ(pick.deviation(), 0);
  pick.estimate.covariance(2, 2) = 1e-6;
  EXPECT_NEAR(pick.deviation(), 1e-3, 1e-9);
  pick.estimate.covariance.setZero();
  // Tilting about x by 0.02 rad: lips stand 42.5 mm from the middle at 0, 120, 240 degrees and 8 mm over it.
  pick.estimate.covariance(3, 3) = 4e-4;
  const double y = 0.0425 * std::sin(2 * std::numbers::pi / 3);
  EXPECT_NEAR(pick.deviation(), 0.02 * std::hypot(y, 0.008), 1e-4);
  EXPECT_LE(pick.deviation(), 0.02 * std::hypot(y, 0.008) + 1e-9);  // what goes along the orbit is not counted
}

TEST(LipDeviation, ATurnAboutTheAxisDoesNotCount) {
  FlatPick pick;
  pick.estimate.covariance(5, 5) = 3.3;
  EXPECT_LT(pick.deviation(), 1e-6);
  pick.part.symmetry.axis.reset();
  EXPECT_NEAR(pick.deviation(), std::sqrt(3.3) * 0.0425, 1e-6);
}

SecondLookConfig config_of(const std::string& yaml) {
  SecondLookConfig config;
  read_yaml_text(yaml, "look.yaml", "", [&](ConfigVisitor& v) { config.visit(v); });
  config.validate();
  return config;
}

TEST(SecondLookConfig, BadValuesAreRefusedByName) {
  const auto refusal = [](const std::string& yaml) -> std::string {
    try {
      config_of(yaml);
    } catch (const SpecError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("when: [no_plan, poor_fit, failed]\nfrom: side\ndistance: 450 mm"), "accepted");
  EXPECT_EQ(refusal("when: []"), "accepted");
  EXPECT_NE(refusal("when: [no_plans]").find("look.yaml:1"), std::string::npos) << refusal("when: [no_plans]");
  EXPECT_NE(refusal("when: [no_plans]").find("did you mean 'no_plan'"), std::string::npos);
  EXPECT_NE(refusal("from: below").find("from"), std::string::npos);
  EXPECT_NE(refusal("distance: 5 mm").find("second_look.distance: must lie"), std::string::npos);
  EXPECT_NE(refusal("tilt: 80 deg").find("second_look.tilt"), std::string::npos);
  EXPECT_NE(refusal("deviation: 0").find("second_look.deviation"), std::string::npos);
  EXPECT_NE(refusal("score: 2").find("second_look.score"), std::string::npos);
}

}  // namespace
}  // namespace binpick

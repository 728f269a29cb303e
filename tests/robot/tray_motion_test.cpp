// The way to the tray: how far the tool tips over, what lies in the tray, and ways around what blocks the direct one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "plan_scene.hpp"
#include "robot/collision_check.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/tool_tilt.hpp"
#include "robot/tray_slots.hpp"

namespace binpick {
namespace {

using namespace testing_robot;

class TiltOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Cells, TiltOf, kCellOfEveryArm);

TEST_P(TiltOf, TheToolStaysUprightOnTheWay) {
  const PlanningConfig config;
  const Scene cell(GetParam(), "bearing_6914");
  const PickPlanner planner(cell.cell, cell.parts, config);
  for (const Pose& X_BP : {flat(0.02, 0.03), flat(-0.09, 0.14), pose_from_xyz_rpy({0, 0.05, 0.03}, {0.2, 0.1, 0})}) {
    Scene scene(GetParam(), "bearing_6914");
    scene.add(X_BP);
    scene.see();
    const PlanResult result = planner.plan(scene.found, scene.view, scene.X_WC, {});
    ASSERT_TRUE(result.plan) << result.reason;
    const JointTrajectory& place = result.plan->place;
    const double ends = std::max(tool_tilt(scene.cell, place.q.front()), tool_tilt(scene.cell, place.q.back()));
    double most = 0;
    for (double t = 0; t <= place.duration(); t += 0.002)  // as it is executed
      most = std::max(most, tool_tilt(scene.cell, place.sample(t)));
    EXPECT_LE(most, ends + config.carry_tilt + 0.002);
  }
}

TEST(TiltBound, ToolTiltIsTheAngleOffTheVertical) {
  const Cell cell = cell_named("mz07_three_cups");
  int reached = 0;
  for (const double tilt : {0.0, 0.3, 0.8, 1.2, 1.8}) {
    const Pose X_WG = pose_from_xyz_rpy({0.40, 0, 0.45}, {0, std::numbers::pi - tilt, 0});
    const Pose X_RF = cell.X_WR.inverse() * X_WG * cell.gripper->X_FG().inverse();
    const std::vector<Vector6d> found = inverse_kinematics(*cell.arm, X_RF, cell.q_look);
    if (found.empty()) continue;
    ++reached;
    EXPECT_NEAR(tool_tilt(cell, found.front()), tilt, 1e-8);
  }
  EXPECT_GE(reached, 3);
}

/// Bearings on end, one upon and beside the other: a wall across the way from the bin to the tray.
std::vector<PlacedPart> wall(double height) {
  std::vector<PlacedPart> parts;
  for (double z = 0.05; z < height; z += 0.1)
    for (double x = 0.1; x < 0.75; x += 0.1)
      parts.push_back({0, pose_from_xyz_rpy({x, -0.265, z}, {std::numbers::pi / 2, 0, 0})});
  return parts;
}

TEST(WaySearch, FindsAWayOverAWallWhereDirectOnesAreBlocked) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(0, 0));
  const std::vector<PlacedPart> parts = wall(0.42);
  PlanningConfig direct;
  direct.search_checks = 0;
  const PlanResult blocked = scene.plan(0, direct, parts);
  EXPECT_FALSE(blocked.plan);
  EXPECT_NE(blocked.reason.find("a part in the tray"), std::string::npos) << blocked.reason;
  const PickPlanner planner(scene.cell, scene.parts, {});
  const PickStart start{0, {}, {}, parts};
  const PlanResult result = planner.plan(scene.found, scene.view, scene.X_WC, start);
  const PlanResult again = planner.plan(scene.found, scene.view, scene.X_WC, start);
  ASSERT_TRUE(result.plan && again.plan) << result.reason;
  CollisionCheck check(scene.cell, 0);
  std::vector<Primitive> wall_W;
  const std::vector<Eigen::Vector3d> outline_P = outline_of(scene.parts[0].mesh_P);
  for (const PlacedPart& part : parts) wall_W.push_back(box_in_tray(scene.cell.tray, outline_P, part.X_WP, 0));
  check.add_placed(wall_W);
  for (const JointTrajectory* path :
       {&result.plan->approach, &result.plan->lift, &result.plan->place, &result.plan->back})
    EXPECT_EQ(check.path_hit(*path, 0.005), Obstacle::kNone);
  const double ends =
      std::max(tool_tilt(scene.cell, result.plan->place.q.front()), tool_tilt(scene.cell, result.plan->place.q.back()));
  EXPECT_LE(largest_tilt(scene.cell, result.plan->place), ends + PlanningConfig{}.carry_tilt);
  EXPECT_EQ(result.plan->place.q, again.plan->place.q);
  EXPECT_EQ(result.plan->place.times, again.plan->place.times);
  EXPECT_EQ(result.plan->back.q, again.plan->back.q);
}

TEST(WaySearch, NoWaySaysSo) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(0, 0));
  PlanningConfig brief;
  brief.search_checks = 3000;
  brief.spins = 1;
  const PlanResult result = scene.plan(0, brief, wall(1.5));
  EXPECT_FALSE(result.plan);
  EXPECT_NE(result.reason.find("no way around found"), std::string::npos) << result.reason;
}

TEST(WaySearch, ChangesNothingWhereADirectWayIsFree) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(0.05, -0.1));
  PlanningConfig direct;
  direct.search_checks = 0;
  const PlanResult without = scene.plan(0, direct), with = scene.plan();
  ASSERT_TRUE(without.plan && with.plan);
  EXPECT_EQ(without.plan->approach.q, with.plan->approach.q);
  EXPECT_EQ(without.plan->place.q, with.plan->place.q);
  EXPECT_EQ(without.plan->back.q, with.plan->back.q);
}

}  // namespace
}  // namespace binpick

#include "robot/plan_pick.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "plan_scene.hpp"
#include "robot/collision_check.hpp"
#include "robot/tray_slots.hpp"

namespace binpick {
namespace {

using namespace testing_robot;

/// What every plan must fulfil.
void expect_sound(const Scene& scene, const PickPlan& plan, const PlanningConfig& config = {}) {
  const Cell& cell = scene.cell;
  const CollisionCheck check(cell, 0);
  EXPECT_EQ(plan.approach.q.front(), cell.q_look);
  EXPECT_EQ(plan.approach.q.back(), plan.lift.q.front());
  EXPECT_EQ(plan.lift.q.back(), plan.place.q.front());
  EXPECT_EQ(plan.place.q.back(), plan.back.q.front());
  EXPECT_EQ(plan.back.q.back(), cell.q_look);
  for (const JointTrajectory* path : {&plan.approach, &plan.lift, &plan.place, &plan.back}) {
    EXPECT_EQ(check.path_hit(*path, 0.005), Obstacle::kNone);
    for (const Vector6d& q : path->q) EXPECT_TRUE(cell.arm->within_limits(q, -1e-9));
  }
  // Pressed contact: the tip stands `press` beyond the believed contact, straight along the tool.
  const Pose X_pressed = plan.X_WG * Eigen::Translation3d(0, 0, config.press);
  EXPECT_LT(largest_difference(cell.tip_pose(plan.approach.q.back()), X_pressed), 1e-8);
  EXPECT_LT((plan.X_WG.translation() - (plan.X_WP_est * plan.site.X_PK).translation()).norm(), 1e-9);
  EXPECT_LT((plan.X_WG.linear().col(2) + (plan.X_WP_est * plan.site.X_PK).linear().col(2)).norm(), 1e-9);
  // Lifted straight up, clear of the rim.
  const Pose X_GP = plan.X_WG.inverse() * plan.X_WP_est;
  const Pose X_lifted = cell.tip_pose(plan.lift.q.back());
  // A leaning part is first drawn 30 mm off along its normal.
  const bool leans = -plan.X_WG.linear()(2, 2) < std::cos(0.2);
  const Eigen::Vector3d foot = plan.X_WG * Eigen::Vector3d(0, 0, leans ? -0.03 : 0);
  EXPECT_LT((X_lifted.translation() - foot).head<2>().norm(), 1e-8);
  double low = 1e9;
  for (const Eigen::Vector3d& p_P : scene.parts.front().mesh_P.vertices)
    low = std::min(low, (X_lifted * X_GP * p_P).z());
  EXPECT_GT(low, (cell.X_WB * Eigen::Vector3d(0, 0, cell.bin.inner_size.z())).z() + 0.01);
  // Released where it is said, in the tray, at the stated height.
  EXPECT_LT(largest_difference(cell.tip_pose(plan.place.q.back()) * X_GP, plan.X_WP_place), 1e-8);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p_P : scene.parts.front().mesh_P.vertices)
    box.extend(cell.tray.X_WT.inverse() * (plan.X_WP_place * p_P));
  EXPECT_GE(box.min().x(), -cell.tray.inner_size.x() / 2);
  EXPECT_LE(box.max().x(), cell.tray.inner_size.x() / 2);
  EXPECT_GE(box.min().y(), -cell.tray.inner_size.y() / 2);
  EXPECT_LE(box.max().y(), cell.tray.inner_size.y() / 2);
}

double height_over_tray(const Scene& scene, const PickPlan& plan) {
  double low = 1e9;
  for (const Eigen::Vector3d& p_P : scene.parts.front().mesh_P.vertices)
    low = std::min(low, (scene.cell.tray.X_WT.inverse() * (plan.X_WP_place * p_P)).z());
  return low;
}

TEST(PlanPick, OneBearingFlatInTheMiddle) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(0, 0));
  const PlanResult result = scene.plan();
  ASSERT_TRUE(result.plan) << result.reason;
  expect_sound(scene, *result.plan);
  EXPECT_LT((result.plan->X_WG.translation() - scene.cell.X_WB * Eigen::Vector3d(0, 0, 0.016)).norm(), 1e-4);
  EXPECT_NEAR(height_over_tray(scene, *result.plan), PlanningConfig{}.place_height, 5e-4);
  // Flat in the tray: it was taken flat, and the tool points straight down.
  EXPECT_NEAR(std::abs(result.plan->X_WP_place.linear()(2, 2)), 1, 1e-9);
}

TEST(PlanPick, BearingsInAllFourCornersAndAlongTheWalls) {
  // Touching both walls, 0.5 mm away from them.
  Scene scene("mz07_three_cups", "bearing_6914");
  const double x = scene.cell.bin.inner_size.x() / 2 - 0.0505, y = scene.cell.bin.inner_size.y() / 2 - 0.0505;
  const PickPlanner planner(scene.cell, scene.parts, {});
  for (const double sx : {-1.0, 0.0, 1.0}) {
    for (const double sy : {-1.0, 0.0, 1.0}) {
      Scene corner("mz07_three_cups", "bearing_6914");
      corner.add(flat(sx * x, sy * y));
      corner.see();
      const PlanResult result = planner.plan(corner.found, corner.view, corner.X_WC, {});
      ASSERT_TRUE(result.plan) << sx << ' ' << sy << ": " << result.reason;
      expect_sound(corner, *result.plan);
    }
  }
}

TEST(PlanPick, TiltedBearingLeaningOnAnother) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(0.06, 0), false);
  scene.add(pose_from_xyz_rpy({-0.03, 0, 0.026}, {0, -0.25, 0}));
  const PlanResult result = scene.plan();
  ASSERT_TRUE(result.plan) << result.reason;
  expect_sound(scene, *result.plan);
}

TEST(PlanPick, PartsOnTopAreTakenFirst) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(0, 0));
  scene.add(flat(0.01, 0.02, 0.024));
  const PlanResult result = scene.plan();
  ASSERT_TRUE(result.plan) << result.reason;
  EXPECT_EQ(result.plan->estimate, 1u);
}

TEST(PlanPick, APartUnderAnotherIsNotTaken) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(0, 0));
  scene.add(flat(0.01, 0.01, 0.024), false);  // lies on it, not detected
  const PlanResult result = scene.plan();
  EXPECT_FALSE(result.plan);
  EXPECT_NE(result.reason.find("in collision with the heap"), std::string::npos) << result.reason;
}

TEST(PlanPick, BearingUprightIsTakenByItsRimWithOneCup) {
  // On its edge no face can be reached; the highest point of the rim can, straight from above, with one of the three
  // cups.
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(pose_from_xyz_rpy({0, 0, 0.05}, {0, std::numbers::pi / 2, 0}));
  const PlanResult result = scene.plan();
  ASSERT_TRUE(result.plan) << result.reason;
  EXPECT_GE(result.plan->site.cup, 0);
  EXPECT_NEAR(result.plan->X_WG.linear()(2, 2), -1, 1e-6);
  const Pose& X_GU = scene.cell.gripper->cups()[static_cast<std::size_t>(result.plan->site.cup)].X_GU;
  const Eigen::Vector3d lip_B = scene.cell.X_WB.inverse() * (result.plan->X_WG * X_GU).translation();
  EXPECT_NEAR(lip_B.x(), 0, 0.002);
  EXPECT_NEAR(lip_B.y(), 0, 0.001);
  EXPECT_NEAR(lip_B.z(), 0.1, 0.001);
}

TEST(PlanPick, AFaceTurnedTowardsTheWallIsNotTaken) {
  // The face looks at the wall and the rim lies under it: the tool would have to stand in the wall.
  Scene scene("mz07_three_cups", "bearing_6914");
  const double x = scene.cell.bin.inner_size.x() / 2;
  scene.add(pose_from_xyz_rpy({x - 0.06, 0, 0.05}, {0, 0.85, 0}));
  const PlanResult result = scene.plan();
  ASSERT_TRUE(!result.plan || result.plan->site.cup >= 0);
  EXPECT_GE(result.rejections.at("at contact in collision with the bin"), 1);
}

TEST(PlanPick, TheToolLeansOffTheNormalWhereThatHelps) {
  // Tilted towards the near wall by 20 degrees: square on the face the stem meets the wall, a leaning tool does not.
  Scene scene("mz07_three_cups", "bearing_6914");
  const double x = scene.cell.bin.inner_size.x() / 2;
  scene.add(pose_from_xyz_rpy({x - 0.062, 0, 0.03}, {0, 0.35, 0}));
  PlanningConfig square;
  square.max_lean = 0;
  const PlanResult stiff = scene.plan(0, square), leaning = scene.plan();
  EXPECT_TRUE(!stiff.plan || stiff.plan->site.cup >= 0);
  ASSERT_TRUE(leaning.plan) << leaning.reason;
  EXPECT_LT(std::acos(-leaning.plan->X_WG.linear()(2, 2)), 0.35 - 0.03);
}

TEST(PlanPick, AFailedPlaceComesLast) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(-0.06, -0.1));
  scene.add(flat(0.06, 0.1));
  const PickPlanner planner(scene.cell, scene.parts, {});
  const PlanResult first = planner.plan(scene.found, scene.view, scene.X_WC, {});
  ASSERT_TRUE(first.plan);
  const std::vector<Eigen::Vector3d> failed = {first.plan->X_WP_est * scene.parts[0].box_center_P};
  const PlanResult second = planner.plan(scene.found, scene.view, scene.X_WC, {0, failed, {}});
  ASSERT_TRUE(second.plan);
  EXPECT_NE(second.plan->estimate, first.plan->estimate);
}

TEST(PlanPick, OutOfReachSaysSo) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.cell.X_WB.translation().x() = 1.0;
  scene.add(flat(0, 0));
  const PlanResult result = scene.plan();
  EXPECT_FALSE(result.plan);
  EXPECT_NE(result.reason.find("out of reach"), std::string::npos) << result.reason;
  // Every candidate that was given up keeps its reason; sites that the tool cannot be tilted to never were candidates.
  std::map<std::string, int> counted = {{"tool tilted too far", result.rejections.at("tool tilted too far")}};
  for (const RejectedCandidate& candidate : result.rejected) ++counted[candidate.reason];
  EXPECT_EQ(counted, result.rejections);
  ASSERT_FALSE(result.rejected.empty());
  EXPECT_NEAR(result.rejected.front().X_WG.translation().x(), 1.0, 0.06);
}

TEST(PlanPick, OneCupOnTheBearingIsRefusedBeforeItPeels) {
  Scene scene("mz07_one_cup", "bearing_6914");
  scene.add(flat(0, 0));
  const PlanResult result = scene.plan();
  EXPECT_FALSE(result.plan);
}

TEST(PlanPick, NothingDetected) {
  Scene scene("mz07_three_cups", "bearing_6914");
  const PlanResult result = scene.plan();
  EXPECT_FALSE(result.plan);
  EXPECT_EQ(result.outcome, PickOutcome::kNoDetection);
}

class SmallPart : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Parts, SmallPart, testing::Values("bracket_l", "tee"));

TEST_P(SmallPart, IsTakenFromTheMiddleAndFromACorner) {
  for (const double share : {0.0, 0.9}) {
    Scene scene("mz07_one_cup", GetParam());
    const Eigen::AlignedBox3d box = bounding_box(scene.parts.front().mesh_P);
    const Eigen::Vector3d free = (scene.cell.bin.inner_size - box.sizes()) / 2;
    Eigen::Vector3d p = -box.center();
    p.head<2>() += share * free.head<2>();
    p.z() = -box.min().z();
    scene.add(pose_from_xyz_rpy(p, {0, 0, 0}));
    const PlanResult result = scene.plan();
    ASSERT_TRUE(result.plan) << share << ": " << result.reason;
    expect_sound(scene, *result.plan);
  }
}

TEST(PlanPick, EveryPlaceOfTheTrayAndASecondLayer) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(0, 0));
  scene.see();
  const PickPlanner planner(scene.cell, scene.parts, {});
  std::vector<Eigen::Vector3d> places;
  for (int placed = 0; placed < 20; ++placed) {
    const PlanResult result = planner.plan(scene.found, scene.view, scene.X_WC, {placed, {}, {}});
    ASSERT_TRUE(result.plan) << placed << ": " << result.reason;
    expect_sound(scene, *result.plan);
    const Eigen::Vector3d p = result.plan->X_WP_place.translation();
    for (const Eigen::Vector3d& other : places)
      EXPECT_TRUE((p - other).head<2>().norm() > 0.1 || std::abs(p.z() - other.z()) > 0.0155) << placed;
    places.push_back(p);
  }
}

TEST(PlanPick, SamePlanTwice) {
  Scene scene("mz07_three_cups", "bearing_6914");
  scene.add(flat(0.03, 0.05));
  scene.add(flat(-0.08, -0.1));
  const PlanResult a = scene.plan(), b = scene.plan();
  ASSERT_TRUE(a.plan && b.plan);
  EXPECT_EQ(a.plan->X_WG.matrix(), b.plan->X_WG.matrix());
  EXPECT_EQ(a.plan->place.q.size(), b.plan->place.q.size());
  EXPECT_EQ(a.plan->place.q.back(), b.plan->place.q.back());
}

TEST(TraySlots, DoNotOverlapAndStayInside) {
  const Eigen::Vector3d inner(0.56, 0.36, 0.04);
  for (int i = 0; i < 15; ++i) {
    const TraySlot a = tray_slot(inner, 0.1, i);
    EXPECT_EQ(a.layer, 0);
    EXPECT_LE(std::abs(a.center_T.x()) + 0.05, inner.x() / 2);
    EXPECT_LE(std::abs(a.center_T.y()) + 0.05, inner.y() / 2);
    for (int j = 0; j < i; ++j) EXPECT_GT((a.center_T - tray_slot(inner, 0.1, j).center_T).norm(), 0.1);
  }
  EXPECT_EQ(tray_slot(inner, 0.1, 15).layer, 1);
  EXPECT_EQ(tray_slot(inner, 0.1, 15).center_T, tray_slot(inner, 0.1, 0).center_T);
}

TEST(PlanningConfig, RefusesNonsense) {
  PlanningConfig config;
  EXPECT_NO_THROW(config.validate());
  config.clearance = -0.001;
  EXPECT_THROW(config.validate(), SpecError);
}

}  // namespace
}  // namespace binpick

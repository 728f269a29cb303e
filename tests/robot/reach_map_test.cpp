// The map against places whose answer is known on paper: within a circle around the shoulder, and beyond it.
#include "robot/reach_map.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "robot/collision_check.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/reach.hpp"
#include "robot_fixture.hpp"

namespace binpick {
namespace {

using namespace testing_robot;

ReachMapConfig coarse() {
  ReachMapConfig config;
  config.place = 0.06;
  config.sides = 4;
  config.spins = 8;
  return config;
}

TEST(ReachMap, CountsEveryPoseOnce) {
  const Cell cell = cell_named("mz07_one_cup");
  const ReachMap map = reach_map(cell, coarse());
  EXPECT_EQ(map.columns, 6);  // 276 mm in steps of at most 60
  EXPECT_EQ(map.rows, 8);     // 376 mm
  ASSERT_EQ(map.places.size(), 48u);
  EXPECT_LT((map.places.front() - Eigen::Vector2d(-0.138, -0.188)).norm(), 1e-12);
  EXPECT_LT((map.places.back() - Eigen::Vector2d(0.138, 0.188)).norm(), 1e-12);
  EXPECT_EQ(map.poses, 48 * 3 * 5);
  int lost = 0;
  for (const auto& [why, poses] : map.lost) lost += poses;
  EXPECT_EQ(map.free + lost, map.poses);
  double sum = 0;
  for (std::size_t i = 0; i < map.places.size(); ++i) sum += map.share(i);
  EXPECT_NEAR(sum / 48 * map.poses, map.free, 1e-6);
  EXPECT_EQ(map.upright, 48 * 3);
}

TEST(ReachMap, AgreesWithTheReachOfSinglePoses) {
  Cell cell = cell_named("mz07_one_cup");
  cell.X_WB.translation().x() = 0.65;  // half of it out of reach
  const ReachMap map = reach_map(cell, coarse());
  ReachMapConfig upright = coarse();
  upright.sides = 0;
  const ReachMap down = reach_map(cell, upright);
  int reached = 0;
  for (std::size_t l = 0; l < down.levels.size(); ++l) {
    for (std::size_t i = 0; i < down.places.size(); ++i) {
      const Eigen::Vector3d p_B(down.places[i].x(), down.places[i].y(), down.levels[l].height);
      const bool within = reaches(cell, cell.X_WB * p_B, -Eigen::Vector3d::UnitZ());
      EXPECT_EQ(down.levels[l].within[i] > 0.5, within) << p_B.transpose();
      reached += within;
    }
  }
  EXPECT_EQ(down.within, reached);
  EXPECT_GT(reached, 10);
  EXPECT_LT(reached, down.poses - 10);
  EXPECT_LT(map.within, map.poses);
  EXPECT_GT(map.lost.at("out of reach"), 0);
}

TEST(ReachMap, ABinOnTheFarSideOfTheTableHasNone) {
  Cell cell = cell_named("mz07_one_cup");
  cell.X_WB.translation() = Eigen::Vector3d(1.6, 0, 0.005);
  const ReachMap map = reach_map(cell, coarse());
  EXPECT_EQ(map.within, 0);
  EXPECT_EQ(map.free, 0);
  EXPECT_EQ(map.lost.at("out of reach"), map.poses);
}

TEST(ReachMap, AWallInTheWayCostsFreedomNotReach) {
  Cell cell = cell_named("mz07_one_cup");
  const ReachMap open = reach_map(cell, coarse());
  cell.tray.X_WT.translation() =
      Eigen::Vector3d(0.495, 0, 0.15);  // a tray across the middle of the bin, as high as its rim
  cell.tray.inner_size = {0.1, 0.1, 0.05};
  const ReachMap blocked = reach_map(cell, coarse());
  EXPECT_EQ(blocked.within, open.within);
  EXPECT_LT(blocked.free, open.free);
  EXPECT_GT(blocked.lost.at("in collision with the tray"), 0);
  EXPECT_EQ(open.lost.count("in collision with the tray"), 0u);
}

/// Does any turn of the tool and any posture of the arm stand free? Every branch of the UR5e lies within its limits.
bool any_free(const Cell& cell, const Eigen::Vector3d& p_W, int spins) {
  const CollisionCheck check(cell, 0);
  for (int k = 0; k < spins; ++k) {
    const Eigen::AngleAxisd turn(2 * std::numbers::pi * k / spins, Eigen::Vector3d::UnitZ());
    const Pose X_WG = pose_from(rotation_with_z(-Eigen::Vector3d::UnitZ()) * turn.toRotationMatrix(), p_W);
    for (const Vector6d& q : all_branches(*cell.arm, cell.X_WR.inverse() * X_WG * cell.gripper->X_FG().inverse()))
      if (check.hit(q) == Obstacle::kNone) return true;
  }
  return false;
}

TEST(ReachMap, OfAThreeParallelAxesArmIsThatOfAllItsBranches) {
  const Cell cell = cell_named("ur5e");
  ReachMapConfig config = coarse();
  config.sides = 0;
  const ReachMap map = reach_map(cell, config);
  EXPECT_EQ(map.within, map.poses);
  for (const ReachLevel& level : map.levels)
    for (std::size_t i = 0; i < map.places.size(); ++i) {
      const Eigen::Vector3d p_W = cell.X_WB * Eigen::Vector3d(map.places[i].x(), map.places[i].y(), level.height);
      EXPECT_EQ(level.free[i] > 0.5, any_free(cell, p_W, config.spins)) << p_W.transpose();
    }
  EXPECT_LT(map.free, map.poses);
}

}  // namespace
}  // namespace binpick

#include "robot/trajectory.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "foreign_arms.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/joint_path.hpp"

namespace binpick {
namespace {

using namespace testing_robot;

/// Largest speed and acceleration over the limits at the override; 1 = exactly at a limit.
struct Load {
  double speed = 0, acceleration = 0;
};

Load load_of(const Arm& arm, const JointTrajectory& path, const MotionLimits& limits) {
  Load load;
  Vector6d last = Vector6d::Zero();
  double last_dt = 0;  // a mean speed belongs to the middle of its interval; before the start the arm rests
  for (std::size_t k = 1; k < path.q.size(); ++k) {
    const double dt = path.times[k] - path.times[k - 1];
    EXPECT_GT(dt, 0);
    const Vector6d speed = (path.q[k] - path.q[k - 1]) / dt;
    for (int i = 0; i < 6; ++i) {
      const double full = arm.limits()[static_cast<std::size_t>(i)].speed;
      load.speed = std::max(load.speed, std::abs(speed[i]) / (full * limits.speed_override));
      const double change = std::abs(speed[i] - last[i]) / ((dt + last_dt) / 2);
      load.acceleration = std::max(load.acceleration, change / (full / limits.acceleration_time));
    }
    last = speed;
    last_dt = dt;
  }
  return load;
}

TEST(JointMove, TrapezoidTimeIsTheFormulas) {
  const Arm arm = mz07();
  MotionLimits limits;
  const double full = arm.limits()[0].speed, v = full * limits.speed_override, a = full / limits.acceleration_time;
  for (const double distance : {0.05, 0.2, 1.0, 2.0}) {
    Vector6d q = Vector6d::Zero();
    q[0] = distance;
    const double expected = distance >= v * v / a ? distance / v + v / a : 2 * std::sqrt(distance / a);
    EXPECT_NEAR(joint_move(arm, Vector6d::Zero(), q, limits).duration(), expected, 1e-9);
  }
}

class EveryArmMoves : public EveryArm {};
INSTANTIATE_TEST_SUITE_P(Arms, EveryArmMoves, testing::ValuesIn(kArms));

TEST_P(EveryArmMoves, StaysWithinSpeedAndAccelerationAndEndsThere) {  // V-C3
  const Rng rng = Seed{3}.child("joint_move").rng();
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Vector6d from = random_joints(arm, rng.at(2 * k)), to = random_joints(arm, rng.at(2 * k + 1));
    const MotionLimits limits;
    const JointTrajectory path = joint_move(arm, from, to, limits);
    EXPECT_EQ(path.q.front(), from);
    EXPECT_EQ(path.q.back(), to);
    const Load load = load_of(arm, path, limits);
    EXPECT_LE(load.speed, 1 + 1e-9) << "draw " << k;
    EXPECT_LE(load.acceleration, 1 + 1e-6) << "draw " << k;
  }
}

TEST_P(EveryArmMoves, IsStraightAndWithinTheLimits) {  // V-C3
  const MotionLimits limits;
  const Rng rng = Seed{3}.child("linear_move").rng();
  int done = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    Rng draw = rng.at(k);
    const Pose X_from =
        pose_from_xyz_rpy({draw.uniform(0.35, 0.6), draw.uniform(-0.2, 0.2), draw.uniform(0.3, 0.5)},
                          {std::numbers::pi + draw.uniform(-0.4, 0.4), draw.uniform(-0.4, 0.4), draw.uniform(-3, 3)});
    Pose X_to = X_from;
    X_to.translation() += 0.15 * draw.unit_vector();
    const std::vector<Vector6d> start = inverse_kinematics(arm, X_from, Vector6d::Zero());
    if (start.empty()) continue;
    const JointTrajectory path = linear_move(arm, start.front(), X_to, limits);
    if (path.empty()) continue;
    ++done;
    EXPECT_LT(largest_difference(arm.forward(path.q.back()), X_to), 1e-9);
    const Load load = load_of(arm, path, limits);
    EXPECT_LE(load.speed, 1 + 1e-9) << "draw " << k;
    EXPECT_LE(load.acceleration, 1.05) << "draw " << k;  // mean speeds of 2 mm steps
    const Eigen::Vector3d way = X_to.translation() - X_from.translation();
    for (std::size_t i = 0; i < path.q.size(); ++i) {
      EXPECT_TRUE(arm.within_limits(path.q[i]));
      const Pose X = arm.forward(path.q[i]);
      EXPECT_LT((X.translation() - X_from.translation()).cross(way.normalized()).norm(), 1e-9);
      EXPECT_LT(angle_between(X.linear(), X_from.linear()), 1e-8);
      if (i == 0) continue;
      const double tool_speed = distance_between(X, arm.forward(path.q[i - 1])) / (path.times[i] - path.times[i - 1]);
      EXPECT_LE(tool_speed, limits.linear_speed * limits.speed_override * (1 + 1e-9));
    }
  }
  EXPECT_GT(done, 100);
}

TEST(LinearMove, OutOfTheWorkspaceIsEmpty) {
  const Arm arm = mz07();
  const Vector6d q = (Vector6d() << 0, 0, 0, 0, 1.5, 0).finished();
  Pose X_to = arm.forward(q);
  X_to.translation().x() += 0.5;
  EXPECT_TRUE(linear_move(arm, q, X_to, {}).empty());
}

TEST(LinearMove, SlowsDownBesideTheWristSingularityInsteadOfFailing) {
  const Arm arm = mz07();
  const Vector6d q = (Vector6d() << 0.2, 0.1, 0.2, 0.1, 0.12, 0).finished();
  Pose X_to = arm.forward(q);
  X_to.translation() += Eigen::Vector3d(0.02, 0.05, 0);
  const MotionLimits limits;
  const JointTrajectory path = linear_move(arm, q, X_to, limits);
  ASSERT_FALSE(path.empty());
  const Load load = load_of(arm, path, limits);
  EXPECT_LE(load.speed, 1 + 1e-9);
  EXPECT_LE(load.acceleration, 1.05);
}

TEST(JointTrajectory, SamplesLinearlyAndClamps) {
  JointTrajectory path;
  path.times = {0, 1, 3};
  path.q = {Vector6d::Zero(), Vector6d::Ones(), Vector6d::Constant(2)};
  EXPECT_EQ(path.sample(-1), path.q.front());
  EXPECT_EQ(path.sample(9), path.q.back());
  EXPECT_LT((path.sample(2) - Vector6d::Constant(1.5)).norm(), 1e-12);
  const JointTrajectory twice = joined(path, path);
  EXPECT_EQ(twice.duration(), 6);
  EXPECT_EQ(twice.q.size(), 5u);
}

Vector6d joints(double q1, double q2) { return (Vector6d() << q1, q2, 0, 0, 1.5, 0).finished(); }

TEST(JointPath, PassesItsPointsWithinTheLimits) {
  const Arm arm = mz07();
  const MotionLimits limits;
  const Rng rng = Seed{7}.child("joint_path").rng();
  for (std::uint64_t k = 0; k < 100; ++k) {
    std::vector<Vector6d> points;
    for (std::uint64_t i = 0; i < 3 + k % 3; ++i) points.push_back(random_joints(arm, rng.at(10 * k + i)));
    const JointTrajectory path = joint_path(arm, points, limits);
    EXPECT_EQ(path.q.front(), points.front());
    EXPECT_EQ(path.q.back(), points.back());
    const Load load = load_of(arm, path, limits);
    EXPECT_LE(load.speed, 1 + 1e-9) << "draw " << k;
    EXPECT_LE(load.acceleration, 1.05) << "draw " << k;  // mean speeds of steps of 10 ms
    double stops = 0;
    for (std::size_t i = 1; i < points.size(); ++i) stops += joint_time(arm, points[i - 1], points[i], limits);
    EXPECT_LT(path.duration(), stops) << "draw " << k;
  }
}

TEST(JointPath, CornersStayInsideTheTriangle) {
  const Arm arm = mz07();
  const JointTrajectory path = joint_path(arm, {joints(0, 0), joints(1, 0), joints(1, 1)}, {});
  double nearest = 1;
  for (const Vector6d& q : path.q) {
    EXPECT_LE(q[0], 1 + 1e-12);
    EXPECT_GE(q[1], -1e-12);
    EXPECT_LE(q[1], q[0] + 1e-12);
    nearest = std::min(nearest, (q - joints(1, 0)).norm());
  }
  // The middle of a parabola from (0.5, 0) by (1, 0) to (1, 0.5) is (0.875, 0.125).
  EXPECT_NEAR(nearest, std::sqrt(2.0) / 8, 0.01);
}

TEST(JointPath, AlongOneLineItTakesTheTimeOfTheDirectMotion) {
  const Arm arm = mz07();
  const Vector6d q_1 = joints(-0.5, 0), q_2 = joints(1.5, 0.4);
  const JointTrajectory path = joint_path(arm, {q_1, (q_1 + q_2) / 2, q_2}, {});
  EXPECT_NEAR(path.duration(), joint_time(arm, q_1, q_2, {}), 0.01);
}

}  // namespace
}  // namespace binpick

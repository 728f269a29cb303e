// Joint motion in time. Trapezoidal profiles under the arm's speed and acceleration limits at a stated override.
#pragma once

#include <vector>

#include "core/config.hpp"
#include "robot/arm.hpp"

namespace binpick {

struct JointTrajectory {
  std::vector<double> times;  ///< s, ascending, first 0
  std::vector<Vector6d> q;    ///< rad, linear between

  bool empty() const { return q.empty(); }
  double duration() const { return times.empty() ? 0 : times.back(); }
  Vector6d sample(double t) const;  ///< clamped to the ends
};

struct MotionLimits {
  double speed_override = 0.5;      ///< share of the arm's joint speeds; the paper runs at 50 %
  double acceleration_time = 0.35;  ///< s to reach full joint speed: acceleration limit = full speed / this
  double linear_speed = 0.25;       ///< m/s along straight approach and retreat, at full override

  void visit(ConfigVisitor& v);
  void validate() const;
};

/// Synchronised point-to-point motion: every joint follows one trapezoidal profile over the same time, none above its
/// limits. With D, v, a of the slowest joint: T = D/v + v/a if D >= v^2/a, else 2 sqrt(D/a) (physical_models C3).
JointTrajectory joint_move(const Arm& arm, const Vector6d& q_from, const Vector6d& q_to, const MotionLimits& limits);

/// Duration of joint_move.
double joint_time(const Arm& arm, const Vector6d& q_from, const Vector6d& q_to, const MotionLimits& limits);

/// Straight Cartesian motion of the flange from `q_from` to X_RF_to, inverse kinematics followed along one branch in
/// steps of at most 2 mm and 1 degree; slower than `linear_speed` where a joint would exceed its speed or acceleration.
/// Empty when it leaves the workspace, a limit or the branch.
JointTrajectory linear_move(const Arm& arm, const Vector6d& q_from, const Pose& X_RF_to, const MotionLimits& limits);

/// The same path, slowed evenly until the origin of frame A, fixed to the flange at X_FA, accelerates by no more than
/// `most` (m/s^2): what is held by friction and vacuum is not thrown off.
JointTrajectory gentle(const Arm& arm, const JointTrajectory& path, const Pose& X_FA, double most);

/// One after the other.
JointTrajectory joined(const JointTrajectory& first, const JointTrajectory& second);

}  // namespace binpick

#include "robot/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.hpp"
#include "core/error.hpp"
#include "robot/inverse_kinematics.hpp"

namespace binpick {
namespace {

constexpr double kSampleTime = 0.01;                   // s, joint moves
constexpr double kStepLength = 0.002;                  // m, linear moves
constexpr double kStepAngle = std::numbers::pi / 180;  // rad, linear moves
// Joint motion within one step that no longer counts as the same branch: a wrist passing so close to its singularity
// would have to stop and turn there.
constexpr double kBranchJump = 0.25;  // rad

/// Path parameter s from 0 to `length` with trapezoidal speed, rest to rest.
struct Trapezoid {
  double length, speed, acceleration;

  double duration() const {
    return length >= speed * speed / acceleration ? length / speed + speed / acceleration
                                                  : 2 * std::sqrt(length / acceleration);
  }
  /// When s is reached.
  double time_of(double s) const {
    const double rise = std::min(length / 2, speed * speed / (2 * acceleration));
    if (s <= rise) return std::sqrt(2 * s / acceleration);
    if (s >= length - rise) return duration() - std::sqrt(2 * std::max(0.0, length - s) / acceleration);
    return speed / acceleration + (s - rise) / speed;
  }
  double at(double t) const {
    const double T = duration(), ramp = std::min(T / 2, speed / acceleration);
    if (t <= ramp) return 0.5 * acceleration * t * t;
    if (t >= T - ramp) return length - 0.5 * acceleration * (T - t) * (T - t);
    return 0.5 * acceleration * ramp * ramp + speed * (t - ramp);
  }
};

double joint_speed(const Arm& arm, int i, const MotionLimits& limits) {
  return arm.limits()[static_cast<std::size_t>(i)].speed * limits.speed_override;
}
double joint_acceleration(const Arm& arm, int i, const MotionLimits& limits) {
  return arm.limits()[static_cast<std::size_t>(i)].speed / limits.acceleration_time;
}

/// Profile from 0 to 1 along `way`, as fast as the slowest joint allows.
Trapezoid joint_profile(const Arm& arm, const Vector6d& way, const MotionLimits& limits) {
  Trapezoid profile{1, 1e9, 1e9};
  for (int i = 0; i < 6; ++i) {
    const double distance = std::abs(way[i]);
    if (distance == 0) continue;
    profile.speed = std::min(profile.speed, joint_speed(arm, i, limits) / distance);
    profile.acceleration = std::min(profile.acceleration, joint_acceleration(arm, i, limits) / distance);
  }
  return profile;
}

/// Joint positions at even steps of the straight line; empty when it leaves workspace, limits or branch.
std::vector<Vector6d> follow_line(const Arm& arm, const Vector6d& q_from, const Pose& X_from, const Pose& X_to) {
  const Eigen::Vector3d turn = log_so3(X_from.linear().transpose() * X_to.linear());
  const double distance = distance_between(X_from, X_to);
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::max(distance / kStepLength, turn.norm() / kStepAngle))));
  std::vector<Vector6d> path = {q_from};
  for (int step = 1; step <= steps; ++step) {
    const double s = static_cast<double>(step) / steps;
    const Pose X =
        pose_from(X_from.linear() * exp_so3(s * turn), (1 - s) * X_from.translation() + s * X_to.translation());
    const std::optional<Vector6d> next = following_solution(arm, X, path.back());
    if (!next || (*next - path.back()).cwiseAbs().maxCoeff() > kBranchJump) return {};
    path.push_back(*next);
  }
  return path;
}

/// The fastest profile over equal steps of s whose joint speeds and accelerations stay within the limits:
/// qdot = q' sdot and qddot = q' sddot + q'' sdot^2, each of the two terms given half of the acceleration limit.
Trapezoid slowest_joint_profile(const Arm& arm, const std::vector<Vector6d>& path, double length,
                                const MotionLimits& limits) {
  const double ds = length / static_cast<double>(path.size() - 1);
  double speed = limits.linear_speed * limits.speed_override, slope_limit = 1e9;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    for (int i = 0; i < 6; ++i) {
      const double a_max = joint_acceleration(arm, i, limits);
      const double slope = std::abs(path[k + 1][i] - path[k][i]) / ds;
      if (slope > 0) {
        speed = std::min(speed, joint_speed(arm, i, limits) / slope);
        slope_limit = std::min(slope_limit, 0.5 * a_max / slope);
      }
      if (k == 0) continue;
      const double bend = std::abs(path[k + 1][i] - 2 * path[k][i] + path[k - 1][i]) / (ds * ds);
      if (bend > 0) speed = std::min(speed, std::sqrt(0.5 * a_max / bend));
    }
  }
  // The tool itself shall not be jerked: full linear speed is reached in the same time as full joint speed.
  return {length, speed, std::min(slope_limit, limits.linear_speed / limits.acceleration_time)};
}

}  // namespace

void MotionLimits::visit(ConfigVisitor& v) {
  v.field("speed_override", speed_override, Unit::kNone, "share of the arm's joint speeds that is used");
  v.field("acceleration_time", acceleration_time, Unit::kTime, "time from rest to full joint speed");
  v.field("linear_speed", linear_speed, Unit::kSpeed, "speed of straight approach and retreat at full override");
}

void MotionLimits::validate() const {
  if (!(speed_override > 0 && speed_override <= 1)) throw SpecError("motion.speed_override: must lie in (0, 1]");
  if (!(acceleration_time >= 0.02 && acceleration_time <= 10))
    throw SpecError("motion.acceleration_time: must lie between 20 ms and 10 s");
  if (!(linear_speed >= 0.005 && linear_speed <= 5))
    throw SpecError("motion.linear_speed: must lie between 5 mm/s and 5 m/s");
}

Vector6d JointTrajectory::sample(double t) const {
  BP_CHECK(!q.empty() && q.size() == times.size());
  const auto next = std::upper_bound(times.begin(), times.end(), t);
  if (next == times.begin()) return q.front();
  if (next == times.end()) return q.back();
  const auto i = static_cast<std::size_t>(next - times.begin());
  const double share = (t - times[i - 1]) / (times[i] - times[i - 1]);
  return (1 - share) * q[i - 1] + share * q[i];
}

double joint_time(const Arm& arm, const Vector6d& q_from, const Vector6d& q_to, const MotionLimits& limits) {
  return q_from == q_to ? 0 : joint_profile(arm, q_to - q_from, limits).duration();
}

JointTrajectory joint_move(const Arm& arm, const Vector6d& q_from, const Vector6d& q_to, const MotionLimits& limits) {
  const Vector6d way = q_to - q_from;
  if (way.cwiseAbs().maxCoeff() < 1e-12) return {{0}, {q_from}};
  const Trapezoid profile = joint_profile(arm, way, limits);
  const double duration = profile.duration();
  const int steps = std::max(2, static_cast<int>(std::ceil(duration / kSampleTime)));
  JointTrajectory out;
  for (int k = 0; k <= steps; ++k) {
    const double t = duration * k / steps;
    out.times.push_back(t);
    out.q.push_back(k == steps ? q_to : Vector6d(q_from + profile.at(t) * way));
  }
  return out;
}

JointTrajectory linear_move(const Arm& arm, const Vector6d& q_from, const Pose& X_RF_to, const MotionLimits& limits) {
  const Pose X_from = arm.forward(q_from);
  const std::vector<Vector6d> path = follow_line(arm, q_from, X_from, X_RF_to);
  if (path.empty()) return {};
  // A turn counts as length, so that a move that only turns has a profile too: 1 rad as 0.2 m.
  const double length =
      std::max(distance_between(X_from, X_RF_to), 0.2 * angle_between(X_from.linear(), X_RF_to.linear()));
  if (length < 1e-9) return {{0}, {q_from}};
  const Trapezoid profile = slowest_joint_profile(arm, path, length, limits);
  JointTrajectory out;
  for (std::size_t k = 0; k < path.size(); ++k) {
    out.times.push_back(profile.time_of(length * static_cast<double>(k) / static_cast<double>(path.size() - 1)));
    out.q.push_back(path[k]);
  }
  return out;
}

JointTrajectory gentle(const Arm& arm, const JointTrajectory& path, const Pose& X_FA, double most) {
  double worst = 0, last_dt = 0;
  Eigen::Vector3d last_p = Eigen::Vector3d::Zero(), last_v = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < path.q.size(); ++k) {
    const Eigen::Vector3d p = (arm.forward(path.q[k]) * X_FA).translation();
    if (k > 0) {
      const double dt = path.times[k] - path.times[k - 1];
      const Eigen::Vector3d v = (p - last_p) / dt;
      worst = std::max(worst, (v - last_v).norm() / ((dt + last_dt) / 2));
      last_v = v;
      last_dt = dt;
    }
    last_p = p;
  }
  JointTrajectory slowed = path;
  const double stretch = std::sqrt(std::max(1.0, worst / most));  // accelerations fall with the square of the time
  for (double& t : slowed.times) t *= stretch;
  return slowed;
}

JointTrajectory joined(const JointTrajectory& first, const JointTrajectory& second) {
  if (first.empty()) return second;
  JointTrajectory out = first;
  for (std::size_t k = 0; k < second.q.size(); ++k) {
    // The common point is not repeated: times ascend strictly.
    if (second.times[k] <= 0) continue;
    out.times.push_back(first.duration() + second.times[k]);
    out.q.push_back(second.q[k]);
  }
  return out;
}

}  // namespace binpick

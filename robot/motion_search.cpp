// MotionPlanner's ways around obstacles, and the bound that a held part sets to all its ways.
#include <algorithm>
#include <cmath>

#include "robot/free_way.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/joint_path.hpp"
#include "robot/motion_planner.hpp"
#include "robot/tool_tilt.hpp"

namespace binpick {
namespace {

constexpr double kOver = 3.15;  // rad, a little more than a tool that hangs head over
constexpr int kShares = 4;      // of a look's checks, one for each search: no hopeless one uses up all

}  // namespace

/// A part held by vacuum peels when the tool tips over: on its way it stays as upright as it is at both ends, but for
/// the margin that the config states.
double MotionPlanner::tilt_bound(const Vector6d& q_from, const Vector6d& q_to) const {
  return std::max(tool_tilt(cell_, q_from), tool_tilt(cell_, q_to)) + config_.carry_tilt;
}

/// The tip where it is at q, the tool turned towards straight down until it is within `tilt`.
std::optional<Vector6d> MotionPlanner::uprighted(const Vector6d& q, double tilt) const {
  const double now = tool_tilt(cell_, q);
  if (now <= tilt) return q;
  const Pose X_WG = cell_.tip_pose(q);
  const Eigen::Vector3d axis = X_WG.linear().col(2).cross(-Eigen::Vector3d::UnitZ());
  if (axis.norm() < 1e-6) return std::nullopt;
  // Not all at the bound: the more it was off, the more it stays off.
  const double turn = now - tilt * now / kOver;
  const Pose X_upright = pose_from(exp_so3(turn * axis.normalized()) * X_WG.linear(), X_WG.translation());
  return following_solution(*cell_.arm, flange_in_base(X_upright), q);
}

bool MotionPlanner::way_is_free(const JointTrajectory& path, const PickTask* held) const {
  if (held && !carry_fault(*held, path).empty()) return false;
  return check_.path_hit(path) == Obstacle::kNone;
}

std::optional<JointTrajectory> MotionPlanner::around(const Vector6d& q_from, const Vector6d& q_to,
                                                     const PickTask* held) const {
  if (!checks_left_ || *checks_left_ <= 0) return std::nullopt;
  const double bound = tilt_bound(q_from, q_to);
  FreeWayQuery query{q_from, q_to, {}, {}};
  query.free = [&](const Vector6d& q) {
    if (held && tool_tilt(cell_, q) > bound) return false;
    if (check_.hit(q) != Obstacle::kNone) return false;
    return !held || carried_hit(*held, q) == Obstacle::kNone;
  };
  if (held) query.draw_near = [&](const Vector6d& q) { return uprighted(q, bound); };
  const int share = std::min(*checks_left_, std::max(1, config_.search_checks / kShares));
  int left = share;
  const auto points = find_free_way(*cell_.arm, query, left);
  *checks_left_ -= share - left;
  if (!points) return std::nullopt;
  JointTrajectory path = joint_path(*cell_.arm, *points, cell_.motion);
  if (way_is_free(path, held)) return path;
  // A corner that was cut met something: the arm stops at each.
  path = {{0}, {q_from}};
  for (std::size_t i = 1; i < points->size(); ++i)
    path = joined(path, joint_move(*cell_.arm, (*points)[i - 1], (*points)[i], cell_.motion));
  if (way_is_free(path, held)) return path;
  return std::nullopt;
}

}  // namespace binpick

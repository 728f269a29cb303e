#include "robot/motion_planner.hpp"

#include <algorithm>
#include <cmath>

#include "robot/inverse_kinematics.hpp"

namespace binpick {
namespace {

constexpr double kLeaning = 0.2;    // rad, parts that lean more are drawn off along their normal first
constexpr double kDrawOff = 0.030;  // m
constexpr double kShortApproach = 0.4;
constexpr double kFreeStep = 0.010;  // m, sampling of a way that begins inside the bin
constexpr std::size_t kStarts = 4;   // arm postures per tip pose that are tried

/// z of the lowest point of `points_A` at X_WA.
double lowest(const std::vector<Eigen::Vector3d>& points_A, const Pose& X_WA) {
  double low = 1e9;
  for (const Eigen::Vector3d& p : points_A) low = std::min(low, (X_WA * p).z());
  return low;
}

}  // namespace

Pose MotionPlanner::raised(const Pose& X, double height) { return Eigen::Translation3d(0, 0, height) * X; }

std::string MotionPlanner::in_the_way(Obstacle obstacle, const char* where) {
  return std::string(where) + " in collision with " + to_string(obstacle);
}

MotionPlanner::MotionPlanner(const Cell& cell, const PlanningConfig& config, const CollisionCheck& check,
                             const Vector6d& q_now)
    : cell_(cell), config_(config), check_(check), X_GF_(cell.gripper->X_FG().inverse()), q_now_(q_now) {}

std::optional<PlannedMotion> MotionPlanner::plan(const PickTask& task, Refusal& refusal) const {
  PlannedMotion out;
  // A shorter straight way reaches places at the edge of the workspace.
  Refusal of_short;
  if (!plan_approach(task, config_.approach, out, refusal) &&
      !plan_approach(task, kShortApproach * config_.approach, out, of_short)) {
    refusal.on_the_way |= of_short.on_the_way;
    return std::nullopt;
  }
  refusal.on_the_way = false;
  if (plan_lift(task, out, refusal.why) && plan_place(task, out, refusal)) return out;
  return std::nullopt;
}

Pose MotionPlanner::flange_in_base(const Pose& X_WG) const { return cell_.X_WR.inverse() * X_WG * X_GF_; }

std::vector<Vector6d> MotionPlanner::joints_for(const Pose& X_WG, const Vector6d& q_near) const {
  std::vector<Vector6d> found = turns_freely(*cell_.arm) ? nearest_postures(*cell_.arm, flange_in_base(X_WG), q_near)
                                                         : inverse_kinematics(*cell_.arm, flange_in_base(X_WG), q_near);
  if (found.size() > kStarts) found.resize(kStarts);
  return found;
}

JointTrajectory MotionPlanner::straight(const Vector6d& q_from, const Pose& X_WG_to) const {
  return linear_move(*cell_.arm, q_from, flange_in_base(X_WG_to), cell_.motion);
}

JointTrajectory MotionPlanner::slowed(const PickTask& task, const JointTrajectory& path) const {
  if (path.empty()) return path;
  const Pose X_FA = cell_.gripper->X_FG() * task.X_GP * Eigen::Translation3d(task.center_P);
  return gentle(*cell_.arm, path, X_FA, task.care * config_.acceleration);
}

double MotionPlanner::rim() const { return (cell_.X_WB * Eigen::Vector3d(0, 0, cell_.bin.inner_size.z())).z(); }

bool MotionPlanner::plan_approach(const PickTask& task, double approach, PlannedMotion& out, Refusal& refusal) const {
  const Pose X_pressed = task.X_WG * Eigen::Translation3d(0, 0, task.press);
  const Pose X_pre = task.X_WG * Eigen::Translation3d(0, 0, -approach);
  double lip_low = 0;  // how far a leaning tool's lowest lip hangs below the tip
  for (const CupSpec& cup : cell_.gripper->cups()) {
    const Eigen::Vector3d z_W = task.X_WG.linear().transpose().col(2);  // world's z in G
    lip_low = std::max(lip_low, -z_W.dot(cup.X_GU.translation()) + cup.radius * z_W.head<2>().norm());
  }
  std::vector<Pose> tips = {X_pressed, X_pre};
  const double above = rim() + kOverRim + lip_low;
  if (X_pre.translation().z() < above) tips.push_back(raised(X_pre, above - X_pre.translation().z()));
  refusal.why = "out of reach";
  for (const Vector6d& q_start : joints_for(tips.back(), cell_.q_look))
    if (approach_from(tips, q_start, out, refusal)) return true;
  return false;
}

/// From where the arm stands to q_start; where that is blocked, back to the look pose first, the way it came.
Obstacle MotionPlanner::way_to(const Vector6d& q_start, JointTrajectory& way) const {
  way = joint_move(*cell_.arm, q_now_, q_start, cell_.motion);
  const bool at_look = q_now_ == cell_.q_look;
  Obstacle hit = at_look ? check_.path_hit(way) : check_.path_hit(way, kFreeStep, true);
  if (hit == Obstacle::kNone) return hit;
  if (!at_look) {
    const JointTrajectory rest = joint_move(*cell_.arm, cell_.q_look, q_start, cell_.motion);
    way = joined(joint_move(*cell_.arm, q_now_, cell_.q_look, cell_.motion), rest);
    hit = check_.path_hit(rest);
  }
  if (hit == Obstacle::kNone) return hit;
  const std::optional<JointTrajectory> found = around(cell_.q_look, q_start, nullptr);
  if (!found) return hit;
  way = at_look ? *found : joined(joint_move(*cell_.arm, q_now_, cell_.q_look, cell_.motion), *found);
  return Obstacle::kNone;
}

/// From where the arm stands to q_start, then straight along `tips` from the last to the first.
bool MotionPlanner::approach_from(const std::vector<Pose>& tips, const Vector6d& q_start, PlannedMotion& out,
                                  Refusal& refusal) const {
  std::vector<JointTrajectory> pieces;
  Vector6d q = q_start;
  for (std::size_t i = tips.size() - 1; i-- > 0;) {
    pieces.push_back(straight(q, tips[i]));
    if (pieces.back().empty()) {
      refusal.why = "straight approach out of reach";
      return false;
    }
    q = pieces.back().q.back();
  }
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
    if (const Obstacle hit = check_.path_hit(*piece); hit != Obstacle::kNone) {
      refusal.why = in_the_way(hit, "approach");
      return false;
    }
  }
  if (const Obstacle hit = way_to(q_start, out.approach); hit != Obstacle::kNone) {
    refusal = {in_the_way(hit, "way to the bin"), true};
    return false;
  }
  for (const JointTrajectory& piece : pieces) out.approach = joined(out.approach, piece);
  return true;
}

bool MotionPlanner::plan_lift(const PickTask& task, PlannedMotion& out, std::string& why) const {
  // A part that leans on a wall is first drawn off it, along its own normal: dragged up along the wall it would slip.
  const double lean = std::acos(std::clamp(-task.X_WG.linear()(2, 2), -1.0, 1.0));
  const double draw_off = lean > kLeaning ? kDrawOff : 0;
  const Pose X_off = task.X_WG * Eigen::Translation3d(0, 0, -draw_off);
  const double height = rim() + kOverRim + kCarryGap - lowest(task.outline_P, X_off * task.X_WG.inverse() * task.X_WP);
  out.lift = {{0}, {out.approach.q.back()}};
  std::vector<Pose> tips = {raised(X_off, std::max(height, config_.approach))};
  if (draw_off > 0) tips.insert(tips.begin(), X_off);
  for (const Pose& X_next : tips) {
    const JointTrajectory piece = straight(out.lift.q.back(), X_next);
    if (piece.empty()) {
      why = "lift out of reach";
      return false;
    }
    out.lift = joined(out.lift, slowed(task, piece));
  }
  if (const Obstacle hit = check_.path_hit(out.lift); hit != Obstacle::kNone) {
    why = in_the_way(hit, "lift");
    return false;
  }
  return true;
}

}  // namespace binpick

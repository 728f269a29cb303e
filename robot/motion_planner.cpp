#include "robot/motion_planner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/inverse_kinematics.hpp"

namespace binpick {
namespace {

constexpr double kOverRim = 0.020;   // m, everything that crosses the bin's rim clears it by this
constexpr double kCarryGap = 0.010;  // m, between a carried part and bin, tray, table
constexpr double kLeaning = 0.2;     // rad, parts that lean more are drawn off along their normal first
constexpr double kDrawOff = 0.030;   // m
constexpr double kShortApproach = 0.4;
constexpr double kFreeStep = 0.010;  // m, sampling of a way that begins inside the bin
constexpr int kYaws = 12;            // turns of the tool over the tray that are tried
constexpr std::size_t kStarts = 4;   // arm postures per tip pose that are tried
constexpr int kWays = 8;             // ways to the tray that are checked in full

/// z of the lowest point of `points_A` at X_WA.
double lowest(const std::vector<Eigen::Vector3d>& points_A, const Pose& X_WA) {
  double low = 1e9;
  for (const Eigen::Vector3d& p : points_A) low = std::min(low, (X_WA * p).z());
  return low;
}

Pose raised(const Pose& X, double height) { return Eigen::Translation3d(0, 0, height) * X; }

std::string in_the_way(Obstacle obstacle, const char* where) {
  return std::string(where) + " in collision with " + to_string(obstacle);
}

}  // namespace

MotionPlanner::MotionPlanner(const Cell& cell, const PlanningConfig& config, const CollisionCheck& check,
                             const Vector6d& q_now)
    : cell_(cell), config_(config), check_(check), X_GF_(cell.gripper->X_FG().inverse()), q_now_(q_now) {}

std::optional<PlannedMotion> MotionPlanner::plan(const PickTask& task, std::string& why) const {
  PlannedMotion out;
  // A shorter straight way reaches places at the edge of the workspace.
  std::string why_short;
  if (!plan_approach(task, config_.approach, out, why) &&
      !plan_approach(task, kShortApproach * config_.approach, out, why_short))
    return std::nullopt;
  if (plan_lift(task, out, why) && plan_place(task, out, why)) return out;
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

bool MotionPlanner::plan_approach(const PickTask& task, double approach, PlannedMotion& out, std::string& why) const {
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
  why = "out of reach";
  for (const Vector6d& q_start : joints_for(tips.back(), cell_.q_look))
    if (approach_from(tips, q_start, out, why)) return true;
  return false;
}

/// From where the arm stands to q_start; where that is blocked, back to the look pose first, the way it came.
Obstacle MotionPlanner::way_to(const Vector6d& q_start, JointTrajectory& way) const {
  way = joint_move(*cell_.arm, q_now_, q_start, cell_.motion);
  if (q_now_ == cell_.q_look) return check_.path_hit(way);
  if (check_.path_hit(way, kFreeStep, true) == Obstacle::kNone) return Obstacle::kNone;
  const JointTrajectory rest = joint_move(*cell_.arm, cell_.q_look, q_start, cell_.motion);
  way = joined(joint_move(*cell_.arm, q_now_, cell_.q_look, cell_.motion), rest);
  return check_.path_hit(rest);
}

/// From where the arm stands to q_start, then straight along `tips` from the last to the first.
bool MotionPlanner::approach_from(const std::vector<Pose>& tips, const Vector6d& q_start, PlannedMotion& out,
                                  std::string& why) const {
  std::vector<JointTrajectory> pieces;
  Vector6d q = q_start;
  for (std::size_t i = tips.size() - 1; i-- > 0;) {
    pieces.push_back(straight(q, tips[i]));
    if (pieces.back().empty()) {
      why = "straight approach out of reach";
      return false;
    }
    q = pieces.back().q.back();
  }
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
    if (const Obstacle hit = check_.path_hit(*piece); hit != Obstacle::kNone) {
      why = in_the_way(hit, "approach");
      return false;
    }
  }
  if (const Obstacle hit = way_to(q_start, out.approach); hit != Obstacle::kNone) {
    why = in_the_way(hit, "way to the bin");
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

MotionPlanner::Place MotionPlanner::place_at(const PickTask& task, double yaw) const {
  const Eigen::Matrix3d R_WG =
      rotation_with_z(-Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  Place place;
  // A part that is held leaning is laid down flat: the tool leans instead.
  const Eigen::Matrix3d upright =
      Eigen::Quaterniond::FromTwoVectors(R_WG * task.X_GP.linear() * task.up_P, Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  place.X_WG = pose_from(upright * R_WG, Eigen::Vector3d::Zero());
  place.X_WP = place.X_WG * task.X_GP;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p_P : task.outline_P) box.extend(place.X_WP * p_P);
  Eigen::Vector3d wanted = cell_.tray.X_WT * Eigen::Vector3d(task.slot_T.x(), task.slot_T.y(), 0);
  wanted.z() += task.layer_height + config_.place_height;
  const Eigen::Vector3d shift = wanted - Eigen::Vector3d(box.center().x(), box.center().y(), box.min().z());
  place.X_WG = Eigen::Translation3d(shift) * place.X_WG;
  place.X_WP = Eigen::Translation3d(shift) * place.X_WP;
  // Over the tray's wall and over neighbours that stand as high as this part.
  place.over = std::max(cell_.tray.inner_size.z(), box.sizes().z()) + kOverRim;
  return place;
}

/// Ways to come down over the place: turns of the tool, and how high the joint motion ends. The quickest first; a low
/// end saves a slow straight way, but the joint motion may then dip below the bin's rim.
std::vector<MotionPlanner::WayToPlace> MotionPlanner::ways_to_place(const PickTask& task,
                                                                    const Vector6d& q_lifted) const {
  std::vector<WayToPlace> ways;
  const double lifted = cell_.tip_pose(q_lifted).translation().z();
  for (int k = 0; k < kYaws; ++k) {
    const Place place = place_at(task, 2 * std::numbers::pi * k / kYaws);
    const double most = std::max(place.over, lifted - place.X_WG.translation().z());
    for (const double over : {place.over, (place.over + most) / 2, most}) {
      for (const Vector6d& q : joints_for(raised(place.X_WG, over), q_lifted)) {
        const double turning =
            joint_time(*cell_.arm, q_lifted, q, cell_.motion) + joint_time(*cell_.arm, q, cell_.q_look, cell_.motion);
        ways.push_back(
            {place, over, q, turning + 2 * over / (cell_.motion.linear_speed * cell_.motion.speed_override)});
      }
    }
  }
  std::stable_sort(ways.begin(), ways.end(), [](const WayToPlace& a, const WayToPlace& b) { return a.time < b.time; });
  return ways;
}

bool MotionPlanner::plan_place(const PickTask& task, PlannedMotion& out, std::string& why) const {
  const Vector6d q_lifted = out.lift.q.back();
  why = "place out of reach";
  int tried = 0;
  for (const WayToPlace& way : ways_to_place(task, q_lifted)) {
    // A way whose end is blocked is no way: it costs one look, and does not count among those that are tried in full.
    if (const Obstacle hit = check_.hit(way.q_over); hit != Obstacle::kNone) {
      why = in_the_way(hit, "release");
      continue;
    }
    // A part that is carried through the bin's wall is the commonest fault, and the cheapest to see.
    const JointTrajectory carry = joint_move(*cell_.arm, q_lifted, way.q_over, cell_.motion);
    if (const Obstacle hit = carried_hit(task, carry); hit != Obstacle::kNone) {
      why = in_the_way(hit, "carried part");
      continue;
    }
    if (place_by(task, way, carry, out, why)) return true;
    if (++tried == kWays) break;
  }
  return false;
}

Obstacle MotionPlanner::carried_hit(const PickTask& task, const JointTrajectory& carry) const {
  Obstacle hit = Obstacle::kNone;
  Vector6d last = Vector6d::Constant(1e9);
  for (std::size_t k = 0; k < carry.q.size() && hit == Obstacle::kNone; ++k) {
    if ((carry.q[k] - last).cwiseAbs().maxCoeff() < 0.02 && k + 1 < carry.q.size()) continue;
    last = carry.q[k];
    const Pose X_WP = cell_.tip_pose(last) * task.X_GP;
    std::vector<Eigen::Vector3d> held_W;
    for (const Eigen::Vector3d& p_P : task.outline_P) held_W.push_back(X_WP * p_P);
    hit = check_.points_hit(held_W, -kCarryGap);
  }
  return hit;
}

bool MotionPlanner::place_by(const PickTask& task, const WayToPlace& way, const JointTrajectory& carry,
                             PlannedMotion& out, std::string& why) const {
  const JointTrajectory down = straight(way.q_over, way.place.X_WG);
  const JointTrajectory up = down.empty() ? down : straight(down.q.back(), raised(way.place.X_WG, way.place.over));
  if (up.empty()) {
    why = "straight way down to the tray out of reach";
    return false;
  }
  const JointTrajectory home = joint_move(*cell_.arm, up.q.back(), cell_.q_look, cell_.motion);
  for (const JointTrajectory* path : {&down, &carry, &home}) {
    const Obstacle hit = check_.path_hit(*path);
    if (hit == Obstacle::kNone) continue;
    why = in_the_way(hit, path == &down ? "release" : path == &carry ? "way to the tray" : "way back");
    return false;
  }
  out.place = joined(slowed(task, carry), slowed(task, down));
  out.back = joined(up, home);
  out.X_WP_place = way.place.X_WP;
  return true;
}

}  // namespace binpick

// MotionPlanner's way to the tray: where the part is laid down, and how it gets there.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/joint_path.hpp"
#include "robot/motion_planner.hpp"
#include "robot/tool_tilt.hpp"

namespace binpick {
namespace {

constexpr int kYaws = 12;            // turns of the tool over the tray that are tried
constexpr int kExamined = 48;        // ways to the tray with a free end that are looked at
constexpr int kWays = 8;             // of them, those that are checked in full
constexpr int kTurned = 6;           // of them, those that are tried past a via point
constexpr int kSearchedWays = 3;     // of them, those to which a way around obstacles is searched
constexpr double kJointStep = 0.02;  // rad, sampling of a carried part
constexpr const char* kTilted = "tool tilted too far on the way to the tray";
constexpr double kSameBranch = 0.7;  // rad, a via point's joints off the direct way

}  // namespace

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

JointTrajectory MotionPlanner::carry_by(const Vector6d& q_lifted, const WayToPlace& way) const {
  if (!way.via) return joint_move(*cell_.arm, q_lifted, way.q_over, cell_.motion);
  return joint_path(*cell_.arm, {q_lifted, *way.via, way.q_over}, cell_.motion);
}

std::string MotionPlanner::carry_fault(const PickTask& task, const JointTrajectory& carry) const {
  if (largest_tilt(cell_, carry) > tilt_bound(carry.q.front(), carry.q.back())) return kTilted;
  // A part that is carried through the bin's wall is the commonest fault, and the cheapest to see.
  const Obstacle hit = carried_hit(task, carry);
  return hit == Obstacle::kNone ? "" : in_the_way(hit, "carried part");
}

/// Where the part on its direct way dips into something: past a via point behind it, as high as the lift ended.
std::optional<MotionPlanner::WayToPlace> MotionPlanner::over_the_edge(const PickTask& task, const WayToPlace& way,
                                                                      const JointTrajectory& carry) const {
  std::size_t behind = carry.q.size();
  Vector6d last = Vector6d::Constant(1e9);
  for (std::size_t k = carry.q.size(); k-- > 0;) {
    if ((carry.q[k] - last).cwiseAbs().maxCoeff() < kJointStep) continue;
    last = carry.q[k];
    if (carried_hit(task, last) != Obstacle::kNone) break;
    behind = k;
  }
  if (behind >= carry.q.size()) return std::nullopt;
  Pose X_via = cell_.tip_pose(carry.q[behind]);
  X_via.translation().z() = std::max(X_via.translation().z(), cell_.tip_pose(carry.q.front()).translation().z());
  const std::vector<Vector6d> q_via = joints_for(X_via, carry.q[behind]);
  if (q_via.empty() || (q_via.front() - carry.q[behind]).cwiseAbs().maxCoeff() > kSameBranch) return std::nullopt;
  WayToPlace over = way;
  over.via = q_via.front();
  over.time += carry_by(carry.q.front(), over).duration() - carry.duration();
  return over;
}

bool MotionPlanner::plan_place(const PickTask& task, PlannedMotion& out, Refusal& refusal) const {
  const Vector6d q_lifted = out.lift.q.back();
  refusal.why = "place out of reach";
  int examined = 0, tried = 0, turned = 0;
  const auto quicker = [](const WayToPlace& a, const WayToPlace& b) { return a.time < b.time; };
  std::vector<WayToPlace> ways = ways_to_place(task, q_lifted);
  for (std::size_t i = 0; i < ways.size() && examined < kExamined && tried < kWays; ++i) {
    const WayToPlace way = ways[i];
    // A way whose end is blocked is no way: it costs one look, and does not count among those that are tried in full.
    if (const Obstacle hit = check_.hit(way.q_over); hit != Obstacle::kNone) {
      refusal.why = in_the_way(hit, "release");
      continue;
    }
    const JointTrajectory carry = carry_by(q_lifted, way);
    if (const std::string fault = carry_fault(task, carry); !fault.empty()) {
      if (!refusal.on_the_way || fault != kTilted) refusal.why = fault;  // what stands in the way says more
      refusal.on_the_way = true;
      if (fault == kTilted) continue;  // quickly seen
      ++examined;
      if (way.via || turned == kTurned) continue;
      const auto next = ways.begin() + static_cast<std::ptrdiff_t>(i) + 1;
      if (const auto over = over_the_edge(task, way, carry)) {
        ways.insert(std::upper_bound(next, ways.end(), *over, quicker), *over);
        ++turned;
      }
      continue;
    }
    if (place_by(task, way, carry, out, refusal)) return true;
    ++tried;
  }
  return refusal.on_the_way && search_place(task, ways, out);
}

/// Searches a way to the quickest places whose ends are free.
bool MotionPlanner::search_place(const PickTask& task, const std::vector<WayToPlace>& ways, PlannedMotion& out) const {
  int searched = 0;
  const Vector6d& q_lifted = out.lift.q.back();
  for (std::size_t i = 0; i < ways.size() && searched < kSearchedWays && checks_left_ && *checks_left_ > 0; ++i) {
    if (ways[i].via || check_.hit(ways[i].q_over) != Obstacle::kNone) continue;
    // Where the direct way throws the tool over, the wrist ends the other way up: no upright way leads there.
    if (largest_tilt(cell_, carry_by(q_lifted, ways[i])) > tilt_bound(q_lifted, ways[i].q_over)) continue;
    ++searched;
    const std::optional<JointTrajectory> carry = around(q_lifted, ways[i].q_over, &task);
    Refusal ignored;
    if (carry && place_by(task, ways[i], *carry, out, ignored)) return true;
  }
  return false;
}

Obstacle MotionPlanner::carried_hit(const PickTask& task, const Vector6d& q) const {
  const Pose X_WP = cell_.tip_pose(q) * task.X_GP;
  std::vector<Eigen::Vector3d> held_W;
  for (const Eigen::Vector3d& p_P : task.outline_P) held_W.push_back(X_WP * p_P);
  return check_.points_hit(held_W, -kCarryGap);
}

Obstacle MotionPlanner::carried_hit(const PickTask& task, const JointTrajectory& carry) const {
  Obstacle hit = Obstacle::kNone;
  Vector6d last = Vector6d::Constant(1e9);
  for (std::size_t k = 0; k < carry.q.size() && hit == Obstacle::kNone; ++k) {
    if ((carry.q[k] - last).cwiseAbs().maxCoeff() < kJointStep && k + 1 < carry.q.size()) continue;
    last = carry.q[k];
    hit = carried_hit(task, last);
  }
  return hit;
}

bool MotionPlanner::place_by(const PickTask& task, const WayToPlace& way, const JointTrajectory& carry,
                             PlannedMotion& out, Refusal& refusal) const {
  const JointTrajectory down = straight(way.q_over, way.place.X_WG);
  const JointTrajectory up = down.empty() ? down : straight(down.q.back(), raised(way.place.X_WG, way.place.over));
  if (up.empty()) {
    refusal.why = "straight way down to the tray out of reach";
    return false;
  }
  JointTrajectory home = joint_move(*cell_.arm, up.q.back(), cell_.q_look, cell_.motion);
  for (const JointTrajectory* path : {&down, &carry, static_cast<const JointTrajectory*>(&home)}) {
    const Obstacle hit = check_.path_hit(*path);
    if (hit == Obstacle::kNone) continue;
    if (path == &home) {
      if (const auto found = around(up.q.back(), cell_.q_look, nullptr)) {
        home = *found;
        continue;
      }
    }
    refusal.why = in_the_way(hit, path == &down ? "release" : path == &carry ? "way to the tray" : "way back");
    refusal.on_the_way |= path != &down;
    return false;
  }
  out.place = joined(slowed(task, carry), slowed(task, down));
  out.back = joined(up, home);
  out.X_WP_place = way.place.X_WP;
  return true;
}

}  // namespace binpick

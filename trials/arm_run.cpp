#include "trials/arm_run.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

constexpr double kAllowedDepth = 0.002;  // m, arm or tool in something fixed
constexpr double kPushTime = 0.010;      // s that a held part must push too hard: one step alone may be an impact

/// The part of a path before (or after) time t, beginning at 0.
JointTrajectory head_of(const JointTrajectory& path, double t) {
  JointTrajectory head;
  for (std::size_t i = 0; i < path.q.size() && path.times[i] < t; ++i) {
    head.times.push_back(path.times[i]);
    head.q.push_back(path.q[i]);
  }
  head.times.push_back(t);
  head.q.push_back(path.sample(t));
  return head;
}

JointTrajectory tail_of(const JointTrajectory& path, double t) {
  JointTrajectory tail;
  tail.times.push_back(0);
  tail.q.push_back(path.sample(t));
  for (std::size_t i = 0; i < path.q.size(); ++i) {
    if (path.times[i] <= t) continue;
    tail.times.push_back(path.times[i] - t);
    tail.q.push_back(path.q[i]);
  }
  return tail;
}

JointTrajectory reversed(const JointTrajectory& path) {
  JointTrajectory back;
  for (std::size_t i = path.q.size(); i-- > 0;) {
    back.times.push_back(path.times.back() - path.times[i]);
    back.q.push_back(path.q[i]);
  }
  return back;
}

}  // namespace

Eigen::Matrix3d ArmRun::turn_of_held() const {
  const World& world = cell_.world();
  return world.pose(cell_.tool_body).linear().transpose() * world.pose(held_).linear();
}

void ArmRun::watch_held(BodyId body) {
  held_ = body;
  R_GP_start_ = turn_of_held();
  for (std::size_t i = 0; i < cell_.heap().bodies.size(); ++i) start_heights_.push_back(cell_.box_center(i).z());
  rise_.assign(start_heights_.size(), 0);
}

void ArmRun::step_held() {
  swing_ = std::max(swing_, angle_between(R_GP_start_, turn_of_held()));
  for (const CupState& cup : cell_.hold().cups())
    if (cup.part) hold_use_ = std::max(hold_use_, cup.use);
  for (std::size_t i = 0; i < rise_.size(); ++i)
    rise_[i] = std::max(rise_[i], cell_.box_center(i).z() - start_heights_[i]);
  touch_held();
}

/// What the held part pushes on, the lips aside.
void ArmRun::touch_held() {
  double force = 0;
  const char* what = "";
  for (const World::BodyContact& contact : cell_.world().contacts(held_)) {
    const World::BodyKind kind = cell_.world().kind(contact.other);
    if (kind == World::BodyKind::kLip || kind == World::BodyKind::kMoved) continue;
    const char* other = kind == World::BodyKind::kFree     ? "held part on another"
                        : contact.other == cell_.bin_body  ? "held part on the bin"
                        : contact.other == cell_.tray_body ? "held part on the tray"
                                                           : "held part on the table";
    if (contact.force > force) force = contact.force, what = other;
    if (contact.depth > contacts_.depth) contacts_.depth = contact.depth, contacts_.entered = other;
  }
  if (force > contacts_.force) contacts_.force = force, contacts_.pushed = what;
  pushed_for_ = force > config_.protective_force ? pushed_for_ + config_.step : 0;
  if (pushed_for_ > kPushTime && !blocked_) blocked_ = Blocked{PickOutcome::kProtectiveStop, what};
}

void ArmRun::step(const Vector6d& q) {
  cell_.set_joints(q);
  cell_.hold().step(config_.step);
  for (const CupState& cup : cell_.hold().cups())
    peak_force_ = std::max({peak_force_, std::hypot(cup.pull, cup.shear), cup.press});
  if (held_ >= 0 && cell_.hold().holds_any()) step_held();
  log_collisions();
}

void ArmRun::log_collisions() {
  std::map<std::string, double> now = cell_.cell_contacts();
  for (const auto& [name, depth] : now) {
    if (!in_contact_.count(name)) ++collisions_[name];
    if (name.rfind("lip", 0) != 0) collision_depth_ = std::max(collision_depth_, depth);
  }
  in_contact_ = std::move(now);
}

bool ArmRun::collides() {
  const CellWorld::Touch touch = cell_.arm_contact(in_contact_);
  peak_force_ = std::max(peak_force_, touch.force);
  if (touch.force > contacts_.force) contacts_.force = touch.force, contacts_.pushed = touch.pushed;
  if (touch.depth > contacts_.depth) contacts_.depth = touch.depth, contacts_.entered = touch.entered;
  if (blocked_) return true;  // by the held part
  if (touch.force > config_.protective_force || touch.depth > kAllowedDepth) {
    const bool pushes = touch.force > config_.protective_force;
    blocked_ = Blocked{pushes ? PickOutcome::kProtectiveStop : PickOutcome::kPathBlocked,
                       pushes ? touch.pushed : touch.entered};
    return true;
  }
  for (const CupState& cup : cell_.hold().cups()) {
    if (cup.part || cup.press <= config_.protective_force) continue;
    blocked_ = Blocked{PickOutcome::kProtectiveStop, "a plunger at its end pressed on something"};
    return true;
  }
  return false;
}

bool ArmRun::follow(const JointTrajectory& path, Watch watch) {
  const int steps = static_cast<int>(std::ceil(path.duration() / config_.step - 1e-9));
  for (int i = 1; i <= steps; ++i) {
    reached_ = std::min(i * config_.step, path.duration());
    step(path.sample(reached_));
    motion_time_ += config_.step;
    if (watch != Watch::kNothing && collides()) return false;
    if (watch == Watch::kHold && !cell_.hold().holds_any()) return false;
  }
  return true;
}

void ArmRun::finish(const JointTrajectory& path) { follow(tail_of(path, reached_), Watch::kNothing); }

void ArmRun::retreat(const JointTrajectory& path) { follow(reversed(head_of(path, reached_)), Watch::kNothing); }

void ArmRun::wait(double duration, bool vacuum) {
  const int steps = static_cast<int>(std::lround(duration / config_.step));
  for (int i = 0; i < steps; ++i) {
    step(cell_.joints());
    (vacuum ? vacuum_time_ : motion_time_) += config_.step;
  }
}

}  // namespace binpick

#include "sim/settle.hpp"

#include <algorithm>

namespace binpick {
namespace {

constexpr double kLostBelow = -1.0;  // m: what fell past everything is taken out, it would fall for ever

std::vector<BodyId> free_bodies(const World& world) {
  std::vector<BodyId> result;
  for (BodyId body = 0; body < world.body_count(); ++body)
    if (world.kind(body) == World::BodyKind::kFree && world.present(body)) result.push_back(body);
  return result;
}

bool all_asleep(const World& world) {
  const std::vector<BodyId> bodies = free_bodies(world);
  return std::none_of(bodies.begin(), bodies.end(), [&](BodyId body) { return world.awake(body); });
}

void drop_lost_bodies(World& world) {
  for (const BodyId body : free_bodies(world)) {
    if (world.mass_center(body).z() > kLostBelow) continue;
    world.put_to_sleep(body);
    world.set_present(body, false);
  }
}

/// Largest motion of any body's points since the last call.
class MotionWindow {
 public:
  double largest(const World& world) {
    double motion = 0;
    std::vector<Pose> now;
    for (BodyId body = 0; body < world.body_count(); ++body) {
      now.push_back(world.pose(body));
      if (world.kind(body) != World::BodyKind::kFree || !world.present(body)) continue;
      const std::size_t i = static_cast<std::size_t>(body);
      if (i >= last_.size()) {
        motion = 1;
        continue;
      }
      const double shift = (now[i].translation() - last_[i].translation()).norm();
      const double turn = angle_between(now[i].linear(), last_[i].linear()) * world.bounding_radius(body);
      motion = std::max({motion, shift, turn});
    }
    last_ = std::move(now);
    return motion;
  }

 private:
  std::vector<Pose> last_;
};

/// Late damping stops the last rollers: from 1.5 s, and harder from 3 s.
bool damp_late(World& world, double time) {
  if (time < 1.5) return false;
  world.set_damping(time < 3 ? 0.3 : 0.54, time < 3 ? 0.5 : 0.9);
  return true;
}

}  // namespace

SettleReport settle_report(World& world, const SettleConfig& config) {
  SettleReport report;
  MotionWindow window;
  window.largest(world);
  double window_end = config.window;
  int quiet_windows = 0;
  while (report.time < config.time_limit && !(report.at_rest = all_asleep(world))) {
    report.damped = damp_late(world, report.time) || report.damped;
    report.time += world.step();
    if (report.time < window_end) continue;
    window_end += config.window;
    quiet_windows = window.largest(world) < config.motion ? quiet_windows + 1 : 0;
    report.at_rest = quiet_windows >= 2;
    if (report.at_rest) break;
    drop_lost_bodies(world);
  }
  world.set_damping(0, 0);
  if (report.at_rest)
    for (const BodyId body : free_bodies(world)) world.put_to_sleep(body);
  return report;
}

bool settle(World& world, const SettleConfig& config, double* time_used) {
  const SettleReport report = settle_report(world, config);
  if (time_used) *time_used = report.time;
  return report.at_rest;
}

}  // namespace binpick

// A heap on a vibrating table.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "sim/drop_stages.hpp"

namespace binpick {
namespace {

constexpr double kStep = 1e-3;    // s
constexpr double kSwell = 0.1;    // of the duration, at either end
constexpr double kMostG = 200.0;  // m/s^2: beyond that a part passes through a wall within a step

std::vector<BodyId> present_parts(const World& world) {
  std::vector<BodyId> result;
  for (BodyId body = 0; body < world.body_count(); ++body)
    if (world.kind(body) == World::BodyKind::kFree && world.present(body)) result.push_back(body);
  return result;
}

}  // namespace

void ShakeConfig::visit(ConfigVisitor& v) {
  v.field("amplitude", amplitude, Unit::kLength, "half the way of the table from end to end");
  v.field("frequency", frequency, Unit::kNone, "of the table in Hz");
  v.field("duration", duration, Unit::kTime, "of the shaking, after the heap came to rest");
  v.field("steepness", steepness, Unit::kAngle, "of the table's way over the horizontal");
}

void ShakeConfig::validate() const {
  if (!(amplitude >= 0 && amplitude <= 0.05)) throw SpecError("drop.shake.amplitude: must lie between 0 and 50 mm");
  if (!(frequency > 0 && frequency <= 100)) throw SpecError("drop.shake.frequency: must lie between 0 and 100 Hz");
  if (!(duration > 0 && duration <= 60)) throw SpecError("drop.shake.duration: must lie between 0 and 60 s");
  if (!(steepness >= 0 && steepness <= 1.5708)) throw SpecError("drop.shake.steepness: must lie between 0 and 90 deg");
  const double omega = 2 * std::numbers::pi * frequency;
  if (!(omega * omega * amplitude <= kMostG))
    throw SpecError("drop.shake: amplitude and frequency make more than 200 m/s^2");
}

void shake(World& world, const ShakeConfig& config, Seed seed) {
  const double omega = 2 * std::numbers::pi * config.frequency;
  const double azimuth = seed.rng().uniform(-std::numbers::pi, std::numbers::pi);
  const Eigen::Vector3d way_W(std::cos(config.steepness) * std::cos(azimuth),
                              std::cos(config.steepness) * std::sin(azimuth), std::sin(config.steepness));
  const std::vector<BodyId> parts = present_parts(world);
  const auto steps = static_cast<int>(std::lround(config.duration / kStep));
  for (int k = 0; k < steps; ++k) {
    const double share = (k + 0.5) / steps;
    const double swell = std::min({1.0, share / kSwell, (1 - share) / kSwell});
    const double acceleration = swell * omega * omega * config.amplitude * std::sin(omega * (k + 0.5) * kStep);
    for (const BodyId part : parts) {
      world.wake(part);
      world.set_velocity(part, world.velocity(part) - kStep * acceleration * way_W, world.angular_velocity(part));
    }
    world.step(kStep);
  }
}

}  // namespace binpick

// Parts out of a tote that is turned over above the bin.
#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "sim/bin.hpp"
#include "sim/drop_stages.hpp"

namespace binpick {
namespace {

constexpr double kWidth = 0.55, kHeight = 0.7,
                 kLength = 0.85;                           // of the bin's inner size: turning, it stays over the bin
constexpr double kWall = 0.01;                             // m
constexpr double kShortestWait = 0.6, kLongestWait = 2.0;  // s, until parts in the tote lie
constexpr double kQuiet = 0.05;                            // m/s
constexpr double kStep = 1e-3;                             // s while it turns
constexpr double kPour = 0.5;                              // s at the end of the turn
constexpr double kGap = 0.02;                              // m

double widest(std::span<const DropItem> items) {
  double diameter = 0;
  for (const DropItem& item : items) diameter = std::max(diameter, item.part->diameter);
  return diameter;
}

BinSpec tote_of(const BinSpec& bin) {
  BinSpec tote = bin.plain();
  tote.inner_size = {kWidth * bin.inner_size.x(), kLength * bin.inner_size.y(), kHeight * bin.inner_size.x()};
  return tote;
}

/// Of the tote's middle over the bin's floor: whichever way it is turned, a part fits between it and a full bin.
double middle_height(std::span<const DropItem> items, const BinSpec& bin) {
  const BinSpec tote = tote_of(bin);
  const double reach = std::hypot(tote.inner_size.x() / 2 + kWall, tote.inner_size.z() / 2 + kWall);
  return bin.inner_size.z() + widest(items) + reach + kGap;
}

void wait_until_quiet(World& world, const std::vector<BodyId>& bodies) {
  const auto moves = [&](BodyId body) { return world.velocity(body).norm() > kQuiet; };
  for (const double start = world.time(); world.time() < start + kLongestWait;) {
    world.step();
    if (world.time() > start + kShortestWait && std::none_of(bodies.begin(), bodies.end(), moves)) return;
  }
}

}  // namespace

void DumpConfig::visit(ConfigVisitor& v) {
  v.field("tilt_time", tilt_time, Unit::kTime, "in which the tote is turned over");
  v.field("tilt_angle", tilt_angle, Unit::kAngle, "of the tote at the end, 0 is upright");
}

void DumpConfig::validate() const {
  if (!(tilt_time >= 0.2 && tilt_time <= 60)) throw SpecError("drop.dump.tilt_time: must lie between 0.2 and 60 s");
  if (!(tilt_angle >= 1.75 && tilt_angle <= 3.1416))
    throw SpecError("drop.dump.tilt_angle: must lie between 100.3 and 180 deg");
}

double dump_top(std::span<const DropItem> items, const BinSpec& bin, const DropConfig& drop) {
  return middle_height(items, bin) + guard_top(items, tote_of(bin), drop);
}

std::vector<BodyId> dump_parts(World& world, std::span<const DropItem> items, const BinSpec& bin, const Pose& X_WB,
                               const DropConfig& drop, Seed seed) {
  const BinSpec tote = tote_of(bin);
  const double room = std::min(tote.inner_size.x(), tote.inner_size.y());
  if (widest(items) > room)
    throw SpecError("drop.kind: dump: a part is longer than its tote is wide; the bin is too small for it");
  const double half = tote.inner_size.z() / 2;
  const Pose X_WA = X_WB * Eigen::Translation3d(0, 0, middle_height(items, bin));  // A: the axis in the tote's middle
  const Pose X_AT(Eigen::Translation3d(0, 0, -half));                              // T: the middle of its floor
  const BodyId body = world.add_moved(bin_boxes(tote, kWall), X_WA * X_AT, {tote.friction, tote.restitution});
  const BodyId guard = add_guard_walls(world, tote, X_WA * X_AT, guard_top(items, tote, drop));
  const std::vector<BodyId> parts = rain_parts(world, items, tote, X_WA * X_AT, drop, seed);
  wait_until_quiet(world, parts);
  world.set_present(guard, false);
  const double way = seed.child("dump").rng().uniform() < 0.5 ? -1 : 1;
  const auto steps = static_cast<int>(std::lround((drop.dump.tilt_time + kPour) / kStep));
  for (int k = 1; k <= steps; ++k) {
    const double s = std::min(1.0, k * kStep / drop.dump.tilt_time);
    const Eigen::AngleAxisd turn(way * drop.dump.tilt_angle * s * s * (3 - 2 * s), Eigen::Vector3d::UnitY());
    world.move_to(body, X_WA * turn * X_AT);
    for (const BodyId part : parts) world.wake(part);
    world.step(kStep);
  }
  world.set_present(body, false);
  for (const BodyId part : parts) world.wake(part);
  return parts;
}

}  // namespace binpick

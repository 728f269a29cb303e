#include "sim/rest_check.hpp"

#include <algorithm>
#include <vector>

#include "core/check.hpp"
#include "sim/bin.hpp"
#include "sim/settle.hpp"
#include "sim/world_impl.hpp"

namespace binpick {
namespace {

using Places = std::vector<btTransform>;

Places places_of(const World& world, std::span<const BodyId> bodies) {
  Places places;
  for (const BodyId body : bodies) places.push_back(world.impl().at(body).rigid->getWorldTransform());
  return places;
}

/// Awake for a while, and still awake afterwards.
WakeReport watch(World& world, std::span<const BodyId> bodies, double duration) {
  const Places before = places_of(world, bodies);
  for (const BodyId body : bodies) world.set_may_sleep(body, false);
  for (const double end = world.time() + duration; world.time() < end;) world.step();
  WakeReport report;
  int moved = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double motion = world.impl().motion_of(world.impl().at(bodies[i]), before[i]);
    report.largest_motion = std::max(report.largest_motion, motion);
    report.energy = std::max(report.energy, world.kinetic_energy(bodies[i]));
    moved += motion > kMoved ? 1 : 0;
    world.set_may_sleep(bodies[i], true);
  }
  if (!bodies.empty()) report.moved_share = moved / static_cast<double>(bodies.size());
  return report;
}

void put_back(World& world, std::span<const BodyId> bodies, const Places& places) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    btRigidBody& rigid = *world.impl().at(bodies[i]).rigid;
    rigid.setWorldTransform(places[i]);
    rigid.setInterpolationWorldTransform(places[i]);
    rigid.clearForces();
    world.put_to_sleep(bodies[i]);
    world.impl().world->updateSingleAabb(&rigid);
  }
}

/// Bodies of the heap that have not been lost, and their solids.
struct HeapBodies {
  std::vector<BodyId> ids;
  std::vector<const SolidProbe*> probes;
};

HeapBodies bodies_of(const World& world, const DropResult& drop, std::span<const SolidProbe> probes) {
  HeapBodies result;
  for (std::size_t k = 0; k < drop.bodies.size(); ++k) {
    BP_CHECK(drop.parts[k] < probes.size());
    if (!world.present(drop.bodies[k])) continue;
    result.ids.push_back(drop.bodies[k]);
    result.probes.push_back(&probes[drop.parts[k]]);
  }
  return result;
}

/// Watches, and lets the heap settle on where it has moved, until it stays or the time is up.
void watch_until_it_stays(World& world, std::span<const BodyId> bodies, const SettleConfig& config, DropResult& drop) {
  while (true) {
    const Places rest = places_of(world, bodies);
    drop.woken = watch(world, bodies, config.wake_time);
    const double left = config.time_limit - drop.settle_time - config.wake_time;
    if (drop.woken.largest_motion <= config.wake_motion || left <= 0) {
      put_back(world, bodies, rest);
      return;
    }
    SettleConfig again = config;
    again.time_limit = left;
    const SettleReport report = settle_report(world, again);
    drop.settle_time += config.wake_time + report.time;
    drop.damped = drop.damped || report.damped;
    if (report.at_rest) continue;
    drop.unsettled = "a part moved on when the heap at rest was woken, and the time was over before all lay still again";
    return;
  }
}

}  // namespace

WakeReport wake_and_watch(World& world, std::span<const BodyId> bodies, double duration) {
  const Places rest = places_of(world, bodies);
  const WakeReport report = watch(world, bodies, duration);
  put_back(world, bodies, rest);
  return report;
}

SolidProbe probe_of(const Part& part) {
  constexpr double kSpacing = 2e-3;  // m
  return {part.envelope_P, std::min(kSpacing, part.diameter / 20)};
}

void check_rest(World& world, const BinSpec& bin, const Pose& X_WB, std::span<const SolidProbe> probes,
                const SettleConfig& config, DropResult& drop) {
  const HeapBodies heap = bodies_of(world, drop, probes);
  if (drop.settled && config.wake_time > 0) {
    watch_until_it_stays(world, heap.ids, config, drop);
    drop.escaped = escaped(world, bin, X_WB, drop);
  }
  drop.penetrations = penetrations(world, heap.ids, heap.probes, bin, X_WB);
  double deepest = 0;
  for (const double depth : drop.penetrations) deepest = std::max(deepest, depth);
  if (drop.unsettled.empty() && drop.woken.largest_motion > config.wake_motion)
    drop.unsettled = "a part moved on when the heap at rest was woken";
  if (drop.unsettled.empty() && deepest > config.max_penetration) drop.unsettled = "the parts' true solids penetrate";
  drop.settled = drop.unsettled.empty();
}

}  // namespace binpick

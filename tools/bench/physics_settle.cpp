#include "tools/bench/physics_settle.hpp"

#include "core/error.hpp"
#include "core/part.hpp"
#include "sim/bare_bullet.hpp"
#include "sim/bin.hpp"
#include "sim/drop.hpp"
#include "tools/bench/cpu_clock.hpp"
#include "trials/scenario.hpp"

namespace binpick {

SettleCost bench_settle(const std::string& scene, int parts, std::uint64_t seed) {
  const Scenario s = read_scenario(scene, {"ideal"});
  if (s.drop.kind != "rain") throw SpecError(scene + ": drop.kind: bare Bullet can only follow rain");
  const Part part = load_part(s.parts.front().spec);
  const CollisionShape shape = collision_shape(part);
  World world(s.physics);
  const BareBullet bare(world, thread_cpu_seconds);
  add_bin(world, s.cell.bin, s.cell.X_WB);
  const std::vector<DropItem> items(static_cast<std::size_t>(parts), {&part, &shape, 0});
  const DropResult heap = drop_parts(world, items, s.cell.bin, s.cell.X_WB, s.drop, s.settle, Seed{seed}.child("drop"));
  const BareBullet::Report report = bare.report();
  SettleCost cost;
  cost.cpu = report.ours;
  cost.bare_cpu = report.bare;
  cost.steps = report.steps;
  cost.different = report.different;
  cost.scene = s.name;
  cost.seed = seed;
  cost.parts = parts;
  cost.fine_iterations = s.physics.fine_iterations;
  cost.coarse_iterations = s.physics.coarse_iterations;
  cost.pieces = shape.pieces_P.size();
  cost.simulated = world.time();
  cost.settled = heap.settled;
  cost.escaped = heap.escaped.size();
  cost.penetration = heap.worst_penetration;
  return cost;
}

}  // namespace binpick

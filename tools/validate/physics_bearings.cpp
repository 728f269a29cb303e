// V-E7: how the paper's ten bearings lie in their bin. No published figure exists: these are values to compare later
// builds with, not a validation.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "evaluation/statistics.hpp"
#include "sim/bin.hpp"
#include "tools/validate/physics_bench.hpp"
#include "trials/scenario.hpp"

namespace binpick {
namespace {

constexpr int kHeaps = 200;
constexpr double kFlat = 10 * std::numbers::pi / 180, kOnEdge = 60 * std::numbers::pi / 180;  // rad
constexpr double kAtWall = 2e-3;                                                              // m

struct Lie {
  bool settled = false;
  double flat = 0, at_wall = 0, tilt = 0;  ///< parts within 10 deg of flat, on edge at a wall; rad, mean over parts
};

double wall_distance(const BinSpec& bin, const Pose& X_BP, const std::vector<Eigen::Vector3d>& corners_P) {
  double nearest = INFINITY;
  for (const Eigen::Vector3d& corner : corners_P) {
    const Eigen::Vector3d p = X_BP * corner;
    nearest = std::min({nearest, bin.inner_size.x() / 2 - std::abs(p.x()), bin.inner_size.y() / 2 - std::abs(p.y())});
  }
  return nearest;
}

Lie drop_bearings(const Scenario& s, const PhysicsConfig& physics, const DropItem& bearing, Seed seed) {
  World world(physics);
  add_bin(world, s.cell.bin, s.cell.X_WB);
  const std::vector<DropItem> items(10, bearing);
  const DropResult heap = drop_parts(world, items, s.cell.bin, s.cell.X_WB, s.drop, s.settle, seed);
  const Eigen::Vector3d axis_P = bearing.part->symmetry.axis->direction_P;
  const std::vector<Eigen::Vector3d> corners_P = hull_vertices(bearing.part->envelope_P);
  Lie lie;
  lie.settled = heap.settled;
  for (const BodyId body : heap.bodies) {
    const Pose X_BP = s.cell.X_WB.inverse() * world.pose(body);
    const double tilt = std::acos(std::min(1.0, std::abs((X_BP.linear() * axis_P).z())));
    lie.flat += tilt < kFlat;
    lie.at_wall += tilt > kOnEdge && wall_distance(s.cell.bin, X_BP, corners_P) < kAtWall;
    lie.tilt += tilt / static_cast<double>(items.size());
  }
  return lie;
}

/// Parts of one heap lean on each other: the interval is over heaps.
Verdict heap_share(const std::string& what, const std::vector<Lie>& lies, double Lie::*parts, Seed seed) {
  std::vector<ClusterCount> heaps;
  double hits = 0;
  for (const Lie& lie : lies) heaps.push_back({lie.*parts, 10}), hits += lie.*parts;
  Verdict line{"V-E7", what, hits / (10.0 * static_cast<double>(lies.size())), 0, 0, "1", Verdict::Rule::kReport};
  const Interval interval = cluster_bootstrap(heaps, seed);
  line.samples = static_cast<int>(lies.size());
  line.low = interval.low, line.high = interval.high;
  return line;
}

}  // namespace

void check_bearings(PhysicsBench& bench) {
  const Scenario s = read_scenario(bench.setting().bearings, {"ideal"});
  const Part part = load_part(s.parts.front().spec);
  if (!part.symmetry.axis) throw SpecError(bench.setting().bearings + ": its part has no axis to measure a tilt of");
  const CollisionShape shape = bench.setting().shape(part);
  std::vector<Lie> lies(static_cast<std::size_t>(bench.count(kHeaps)));
  bench.each("bearings", static_cast<int>(lies.size()), [&](Rng&, std::size_t i) {
    lies[i] = drop_bearings(s, bench.setting().physics, {&part, &shape, 0}, bench.seed("bearings", i));
    return 0.0;
  });
  std::vector<double> tilts;
  std::size_t settled = 0;
  for (const Lie& lie : lies) tilts.push_back(lie.tilt), settled += lie.settled;
  constexpr auto kReport = Verdict::Rule::kReport;
  const Seed seed = bench.seed("bearings bootstrap", 0);
  bench.add(share_line({"V-E7", "heaps of ten bearings: share at rest", 0, 1, 0, "1", kReport}, settled, lies.size()));
  bench.add(heap_share("ten bearings: share within 10 deg of flat", lies, &Lie::flat, seed));
  bench.add(heap_share("ten bearings: share on edge (> 60 deg) at a wall", lies, &Lie::at_wall, seed));
  bench.add(mean_line({"V-E7", "ten bearings: mean tilt", 0, 0, 0, "rad", kReport}, tilts));
}

}  // namespace binpick

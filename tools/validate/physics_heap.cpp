// V-E6 and V-E7: many bodies at once. Equal balls that are let go together and come to rest in a box, and the paper's
// bin of ten bearings.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "core/part.hpp"
#include "sim/bin.hpp"
#include "sim/settle.hpp"
#include "tools/validate/physics_bench.hpp"

namespace binpick {
namespace {

constexpr double kRadius = 0.015, kAluminium = 2700, kResimulated = 2, kTimeLimit = 5;  // m, kg/m^3, s
constexpr double kWall = 3 * kRadius;  // m: balls nearer to a wall or to the surface stand in layers

struct Heap {
  std::vector<BodyId> balls;
  BinSpec bin;
  bool at_rest = false;
  double mass = 0;
};

/// A loose cloud of balls over the floor of a box, jittered, that falls as one: eleven layers high at rest.
Heap pour(World& world, int count, Rng& rng) {
  const int side = std::max(4, static_cast<int>(std::lround(std::cbrt(count / 1.45))));
  constexpr double kPitch = 2.4 * kRadius;
  Heap heap;
  heap.bin.inner_size = {side * kPitch, side * kPitch, 2 * kPitch * count / (side * side) + 0.2};
  heap.bin.friction = 0.4, heap.bin.restitution = 0.1;
  add_bin(world, heap.bin, Pose::Identity());
  const Solid solid = ball(kRadius, kAluminium);
  heap.mass = solid.part.mass.mass;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d cell(i % side + 0.5 - side / 2.0, i / side % side + 0.5 - side / 2.0,
                               i / (side * side) + 1.0);
    Eigen::Vector3d jitter;
    for (int k = 0; k < 3; ++k) jitter[k] = rng.uniform(-0.19, 0.19) * kRadius;
    heap.balls.push_back(world.add_free(solid.part, solid.shape, Pose(Eigen::Translation3d(kPitch * cell + jitter))));
  }
  SettleConfig settle;
  settle.time_limit = kTimeLimit;
  heap.at_rest = settle_report(world, settle).at_rest;
  return heap;
}

std::vector<Eigen::Vector3d> centres(const World& world, const Heap& heap) {
  std::vector<Eigen::Vector3d> result;
  for (const BodyId ball : heap.balls) result.push_back(world.mass_center(ball));
  return result;
}

/// Share of the heap's inside that balls fill, by points drawn there.
double packing(const std::vector<Eigen::Vector3d>& centres_W, const BinSpec& bin, Rng& rng) {
  std::vector<double> heights;
  for (const Eigen::Vector3d& c : centres_W) heights.push_back(c.z());
  std::sort(heights.begin(), heights.end());
  const double top = heights[heights.size() * 9 / 10] - kWall, wide = bin.inner_size.x() / 2 - kWall;
  constexpr int kPoints = 40000;
  int inside = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double x = rng.uniform(-wide, wide), y = rng.uniform(-wide, wide), z = rng.uniform(kWall, top);
    inside += std::any_of(centres_W.begin(), centres_W.end(), [&](const Eigen::Vector3d& c) {
      return (c - Eigen::Vector3d(x, y, z)).squaredNorm() < kRadius * kRadius;
    });
  }
  return static_cast<double>(inside) / kPoints;
}

/// Deepest overlap of two balls, or of a ball with floor and walls, as a share of the diameter.
double overlap(const std::vector<Eigen::Vector3d>& centres_W, const BinSpec& bin) {
  double deepest = 0;
  for (std::size_t i = 0; i < centres_W.size(); ++i) {
    const Eigen::Vector3d& c = centres_W[i];
    const double wall = std::min(bin.inner_size.x() / 2 - std::abs(c.x()), bin.inner_size.y() / 2 - std::abs(c.y()));
    deepest = std::max(deepest, kRadius - std::min(wall, c.z()));
    for (std::size_t k = 0; k < i; ++k) deepest = std::max(deepest, 2 * kRadius - (c - centres_W[k]).norm());
  }
  return deepest / (2 * kRadius);
}

struct Woken {
  double energy = 0, motion = 0;  ///< J, m: the largest of any ball
};

/// Two seconds more with nothing asleep.
Woken resimulate(World& world, const Heap& heap) {
  const std::vector<Eigen::Vector3d> before = centres(world, heap);
  Woken woken;
  for (const double end = world.time() + kResimulated; world.time() < end;) {
    for (const BodyId ball : heap.balls) world.wake(ball);
    world.step();
    for (const BodyId ball : heap.balls) {
      const double v2 = world.velocity(ball).squaredNorm(), w2 = world.angular_velocity(ball).squaredNorm();
      woken.energy = std::max(woken.energy, heap.mass * (v2 + 0.4 * kRadius * kRadius * w2) / 2);
    }
  }
  const std::vector<Eigen::Vector3d> after = centres(world, heap);
  for (std::size_t i = 0; i < after.size(); ++i) woken.motion = std::max(woken.motion, (after[i] - before[i]).norm());
  return woken;
}

}  // namespace

void check_spheres(PhysicsBench& bench) {
  const int count = bench.quick() ? 60 : 1000;
  Rng rng = bench.rng("spheres", 0);
  World world(bench.setting().physics);
  const Heap heap = pour(world, count, rng);
  const std::vector<Eigen::Vector3d> centres_W = centres(world, heap);
  const std::string what = std::to_string(count) + " balls poured: ";
  bench.add({"V-E6", what + "at rest within 5 s", heap.at_rest ? 1.0 : 0.0, 1, 0, "1"});
  // The inside of the quick form's heap is smaller than two balls.
  bench.add({"V-E6", what + "share of the inside that is filled", packing(centres_W, heap.bin, rng), 0.585, 0.035, "1",
             bench.quick() ? Verdict::Rule::kReport : Verdict::Rule::kWithin});
  bench.add({"V-E6", what + "deepest overlap over diameter", overlap(centres_W, heap.bin), 0.01, 0, "1",
             Verdict::Rule::kBelow});
  const Woken woken = resimulate(world, heap);
  bench.add({"V-E6", what + "largest kinetic energy of one, 2 s more awake", woken.energy, 1e-6, 0, "J",
             Verdict::Rule::kBelow});
  bench.add({"V-E6", what + "largest motion of one in these 2 s", woken.motion, 1e-4, 0, "m", Verdict::Rule::kBelow});
}

}  // namespace binpick

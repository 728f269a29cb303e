// Heaps out of a tote and on a vibrating table.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "example_parts.hpp"
#include "sim/bin.hpp"
#include "sim/drop_stages.hpp"

namespace binpick {
namespace {

struct Heap {
  DropResult result;
  std::uint64_t hash = 0;
  double mean_height = 0;  ///< m, of the mass centres over the floor
  int moved_bodies_left = 0;
};

Heap dropped(const std::string& kind, const Part& part, int count, Seed seed) {
  const CollisionShape shape = collision_shape(part);
  World world{PhysicsConfig{}};
  const Pose X_WB(Eigen::Translation3d(0.5, 0.1, 0.02));
  const BinSpec bin;
  add_bin(world, bin, X_WB);
  DropConfig drop;
  drop.kind = kind;
  const std::vector<DropItem> items(static_cast<std::size_t>(count), {&part, &shape, 0});
  Heap heap;
  heap.result = drop_parts(world, items, bin, X_WB, drop, SettleConfig{}, seed);
  heap.hash = world.state_hash();
  for (const BodyId body : heap.result.bodies) heap.mean_height += (world.mass_center(body).z() - 0.02) / count;
  for (BodyId body = 0; body < world.body_count(); ++body)
    heap.moved_bodies_left += world.kind(body) == World::BodyKind::kMoved && world.present(body);
  return heap;
}

TEST(Dump, EverythingLiesInTheBinAndTheToteIsGone) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Heap heap = dropped("dump", example::box({0.06, 0.05, 0.04}), 10, Seed{seed});
    EXPECT_EQ(heap.result.bodies.size(), 10u);
    EXPECT_EQ(heap.result.parts.size(), 10u);
    EXPECT_TRUE(heap.result.settled) << "seed " << seed;
    EXPECT_TRUE(heap.result.escaped.empty()) << "seed " << seed;
    EXPECT_LT(heap.result.worst_penetration, 1e-3) << "seed " << seed;
    EXPECT_EQ(heap.moved_bodies_left, 0);
    EXPECT_GT(heap.mean_height, 0.0199);  // of a box on its broadest side
    EXPECT_LT(heap.mean_height, 0.08);    // not on the rim, not in the air
  }
}

TEST(Dump, SameSeedGivesTheSameBits) {
  const Part part = example::box({0.06, 0.05, 0.04});
  const Heap first = dropped("dump", part, 4, Seed{5}), second = dropped("dump", part, 4, Seed{5});
  EXPECT_EQ(first.hash, second.hash);
  EXPECT_NE(first.hash, dropped("dump", part, 4, Seed{6}).hash);
  EXPECT_NE(first.hash, dropped("rain", part, 4, Seed{5}).hash);
}

TEST(Dump, APartThatDoesNotFitTheToteIsRefused) {
  EXPECT_THROW(dropped("dump", example::box({0.24, 0.02, 0.02}), 1, Seed{1}), SpecError);
}

TEST(Shake, AShakenHeapSettlesAgainInsideTheBin) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Part part = example::box({0.08, 0.03, 0.03});
    const Heap rain = dropped("rain", part, 16, Seed{seed}), heap = dropped("shaken", part, 16, Seed{seed});
    EXPECT_TRUE(heap.result.settled) << "seed " << seed;
    EXPECT_TRUE(heap.result.escaped.empty()) << "seed " << seed;
    EXPECT_NE(heap.hash, rain.hash) << "seed " << seed;
  }
}

TEST(Shake, AColumnOfCubesFallsDown) {
  World world{PhysicsConfig{}};
  const Primitive floor = example::slab();
  world.add_fixed(std::span(&floor, 1), Pose::Identity(), {0.4, 0});
  const Part part = example::box({0.03, 0.03, 0.03});
  const CollisionShape shape = collision_shape(part);
  std::vector<BodyId> cubes;
  for (int k = 0; k < 5; ++k) cubes.push_back(world.add_free(part, shape, Pose(Eigen::Translation3d(0, 0, 0.03 * k))));
  ASSERT_TRUE(settle(world, SettleConfig{}));
  EXPECT_NEAR(world.mass_center(cubes.back()).z(), 0.135, 1e-3);
  shake(world, {0.01, 5, 1.0, 0},
        Seed{1});  // to one g sideways: a column five times as high as wide topples at a fifth
  ASSERT_TRUE(settle(world, SettleConfig{}));
  EXPECT_LT(world.mass_center(cubes.back()).z(), 0.1);
}

TEST(Shake, AFreePartGainsTheIntegralOfTheAcceleration) {
  // Half a period in weightlessness: everything pushes one way.
  PhysicsConfig weightless;
  weightless.gravity = 0;
  World world(weightless);
  const Part part = example::box({0.02, 0.02, 0.02});
  const BodyId body = world.add_free(part, collision_shape(part), Pose::Identity());
  const ShakeConfig config{0.01, 5, 0.1, 0.5};
  shake(world, config, Seed{3});
  double gained = 0;
  const int n = 100000;
  for (int k = 0; k < n; ++k) {
    const double share = (k + 0.5) / n, omega = 2 * std::numbers::pi * 5;
    const double swell = share < 0.1 ? share / 0.1 : share > 0.9 ? (1 - share) / 0.1 : 1;
    gained += swell * omega * omega * 0.01 * std::sin(omega * 0.1 * share) * 0.1 / n;
  }
  EXPECT_NEAR(world.velocity(body).norm(), gained, 1e-3 * gained);
  EXPECT_NEAR(-world.velocity(body).z(), gained * std::sin(0.5), 1e-3 * gained);
}

TEST(Shake, FrictionHoldsABoxUntilTheTableOutrunsIt) {
  // Floor and box 0.4: along the floor the box slides when the table's acceleration passes 0.4 g = 3.9 m/s^2.
  const auto moved = [](double acceleration) {
    World world{PhysicsConfig{}};
    const Primitive floor = example::slab();
    world.add_fixed(std::span(&floor, 1), Pose::Identity(), {0.4, 0});
    const Part part = example::box({0.04, 0.04, 0.02});
    const BodyId body = world.add_free(part, collision_shape(part), Pose::Identity());
    for (int k = 0; k < 200; ++k) world.step(1e-3);
    const Eigen::Vector3d before = world.mass_center(body);
    const double omega = 2 * std::numbers::pi * 2;  // a quarter of a second to one side, then back
    shake(world, {acceleration / (omega * omega), 2, 0.25, 0}, Seed{1});
    return (world.mass_center(body) - before).head<2>().norm();
  };
  EXPECT_LT(moved(2.5), 2e-4);
  EXPECT_GT(moved(8.0), 5e-3);
}

}  // namespace
}  // namespace binpick

// Friction that starts from the last step's impulse.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "example_parts.hpp"
#include "sim/bin.hpp"
#include "sim/rest_check.hpp"

namespace binpick {
namespace {

/// A brick on a slope, friction 0.5.
struct Slope {
  Slope(double angle, int iterations) : world(physics(iterations)) {
    const Pose X_WS = pose_from(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix(), {0, 0, 0});
    const std::vector<Primitive> slab = {Primitive::box({3, 1, 0.1}, Pose(Eigen::Translation3d(0, 0, -0.05)))};
    world.add_fixed(slab, X_WS, {0.5, 0});
    part.friction = 0.5;
    brick = world.add_free(part, collision_shape(part), X_WS * Pose(Eigen::Translation3d(0, 0, 0.01)));
  }
  static PhysicsConfig physics(int iterations) {
    PhysicsConfig config;
    config.iterations = iterations;
    return config;
  }
  /// m, that the brick goes in so many seconds.
  double way(double duration, double step) {
    const Eigen::Vector3d start = world.mass_center(brick);
    for (const double end = world.time() + duration; world.time() < end;) {
      world.wake(brick);
      world.step(step);
    }
    return (world.mass_center(brick) - start).norm();
  }

  Part part = example::box({0.06, 0.04, 0.02});
  World world;
  BodyId brick = -1;
};

TEST(HeapSolver, AHeapOfRingsIsStillWithFewIterations) {
  PhysicsConfig physics;
  physics.coarse_iterations = 30;  // with friction from nothing the rings creep by 0.1 to 0.7 mm
  const Part ring = example::ring();
  const CollisionShape shape = collision_shape(ring);
  const SolidProbe probe = probe_of(ring);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    World world(physics);
    const BinSpec bin;
    add_bin(world, bin, Pose::Identity());
    const std::vector<DropItem> items(12, {&ring, &shape, 0});
    DropResult heap = drop_parts(world, items, bin, Pose::Identity(), DropConfig{}, SettleConfig{}, Seed{seed});
    check_rest(world, bin, Pose::Identity(), std::span(&probe, 1), SettleConfig{}, heap);
    EXPECT_TRUE(heap.settled) << "seed " << seed;
    EXPECT_LT(heap.woken.largest_motion, 0.1e-3) << "seed " << seed;
  }
}

TEST(HeapSolver, WhatSlipsIsBrakedNoHarderThanCoulombSays) {
  const double angle = std::atan(0.7), before = 0.1, time = 0.5;
  Slope slope(angle, 15);
  slope.way(before, 1e-3);
  const double a = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle)), expected = a * before * time + a * time * time / 2;
  EXPECT_NEAR(slope.way(time, 1e-3), expected, 0.03 * expected);
}

}  // namespace
}  // namespace binpick

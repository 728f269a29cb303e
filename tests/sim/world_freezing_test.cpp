// Frozen parts: the same heap to the bit while nothing happens, and no part stays a wall, hangs in the air or is passed
// through when something does.
#include <gtest/gtest.h>

#include <algorithm>

#include "example_parts.hpp"
#include "sim/world.hpp"

namespace binpick {
namespace {

constexpr double kStep = 1.0 / 500;
constexpr double kEdge = 0.04;  // m, of the cubes

Pose shifted(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

/// Cubes in a tower or a row on the floor, at rest and asleep.
class Cubes : public ::testing::Test {
 protected:
  void build(int count, const Eigen::Vector3d& offset, const PhysicsConfig& config = {}) {
    world = std::make_unique<World>(config);
    const Primitive slab = example::slab();
    world->add_fixed({&slab, 1}, Pose::Identity(), {0.4, 0});
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d p = i * offset;
      cubes.push_back(world->add_free(cube, collision_shape(cube), shifted(p.x(), p.y(), p.z())));
    }
    run(1);
    for (const BodyId body : cubes) world->put_to_sleep(body);
  }
  void run(double duration) {
    for (int i = 0; i < std::lround(duration / kStep); ++i) world->step(kStep);
  }
  double height(int i) const { return world->pose(cubes[static_cast<std::size_t>(i)]).translation().z(); }

  const Part cube = example::box({kEdge, kEdge, kEdge});
  std::unique_ptr<World> world;
  std::vector<BodyId> cubes;
};

TEST_F(Cubes, WhatIsLeftAloneKeepsItsBits) {
  build(3, {0, 0, kEdge});
  const std::uint64_t before = world->state_hash();
  world->freeze_sleeping();
  EXPECT_EQ(world->frozen_count(), 3);
  run(1);
  EXPECT_EQ(world->frozen_count(), 3);
  world->end_freezing();
  EXPECT_EQ(world->frozen_count(), 0);
  run(1);
  EXPECT_EQ(world->state_hash(), before);
}

TEST_F(Cubes, SwitchedOffNothingIsFrozen) {
  PhysicsConfig config;
  config.freeze_far = false;
  build(2, {0, 0, kEdge}, config);
  world->freeze_sleeping();
  EXPECT_EQ(world->frozen_count(), 0);
}

TEST_F(Cubes, ATowerFallsWhenItsLowestCubeIsTaken) {
  build(4, {0, 0, kEdge});
  world->freeze_sleeping();
  world->set_velocity(cubes[0], {0, 0, 0}, {0, 0, 0});
  world->teleport(cubes[0], shifted(0.5, 0, 0));
  run(1);
  EXPECT_NEAR(height(1), 0, 5e-4);
  EXPECT_NEAR(height(2), kEdge, 5e-4);
  EXPECT_NEAR(height(3), 2 * kEdge, 5e-4);
  EXPECT_EQ(world->frozen_count(), 4) << "all at rest again";
}

TEST_F(Cubes, ARowIsPushedAsAWholeAndIsNeverAWall) {
  build(5, {kEdge + 1e-4, 0, 0});
  world->freeze_sleeping();
  const Primitive pusher = Primitive::box({0.02, 0.02, 0.02}, Pose::Identity());
  const BodyId tool = world->add_moved({&pusher, 1}, shifted(-0.05, kEdge / 2, kEdge / 2), {0.4, 0});
  double largest = 0;
  for (int i = 1; i <= 400; ++i) {
    world->move_to(tool, shifted(-0.05 + 0.1 * kStep * i, kEdge / 2, kEdge / 2));
    world->step(kStep);
    for (const World::BodyContact& contact : world->contacts(tool)) largest = std::max(largest, contact.force);
  }
  // The tool's face ends at x = 0.04: it has pushed all five by that much, less the gaps.
  for (int k = 0; k < 5; ++k)
    EXPECT_NEAR(world->pose(cubes[static_cast<std::size_t>(k)]).translation().x(), 0.04 + k * kEdge, 1.5e-3) << k;
  // Friction of the row is 5 x 0.4 x 1.7 N; being stopped and started costs m v / dt = 9 N each.
  EXPECT_LT(largest, 5 * 0.4 * 1.7 + 5 * 9);
}

TEST_F(Cubes, AFastCubeKnocksAFrozenOneAway) {
  build(2, {0.2, 0, 0});
  world->freeze_sleeping();
  world->set_velocity(cubes[0], {1.5, 0, 0}, {0, 0, 0});
  world->wake(cubes[0]);
  run(1);
  EXPECT_GT(world->pose(cubes[1]).translation().x(), 0.2 + 0.01);
}

}  // namespace
}  // namespace binpick

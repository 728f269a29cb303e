// Single bodies whose motion is known on paper (V-E5), resting height against the exact mesh, pairs of materials.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "example_parts.hpp"
#include "sim/bin.hpp"
#include "sim/drop.hpp"
#include "sim/world.hpp"

namespace binpick {
namespace {

constexpr double kGravity = 9.81;
constexpr double kStep = 1.0 / 1000;

Pose shifted(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

Pose tilted(double angle) { return Pose(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY())); }

BodyId add_slab(World& world, double angle, const SurfaceMaterial& material) {
  const Primitive slab = example::slab();
  return world.add_fixed({&slab, 1}, tilted(angle), material);
}

void run(World& world, double duration, double dt = kStep) {
  for (int i = 0; i < std::lround(duration / dt); ++i) world.step(dt);
}

TEST(World, FreeFallFollowsHalfGTSquared) {
  World world{PhysicsConfig{}};
  const Part part = example::box({0.06, 0.04, 0.03});
  const Pose X_start = shifted(0.3, -0.2, 5);
  const BodyId body = world.add_free(part, collision_shape(part), X_start);
  EXPECT_LT((world.pose(body).translation() - X_start.translation()).norm(), 1e-12);
  run(world, 0.5);
  EXPECT_NEAR(5 - world.pose(body).translation().z(), 0.5 * kGravity * 0.25, 0.003 * 0.5 * kGravity * 0.25);
  EXPECT_NEAR(world.pose(body).translation().x(), 0.3, 1e-12);
  EXPECT_NEAR(world.velocity(body).z(), -kGravity * 0.5, 1e-9);
}

TEST(World, BounceHeightIsTheSquareOfRestitution) {
  World world{PhysicsConfig{}};
  const Part part = example::bipyramid(0.02, 0.02, 0.6);
  add_slab(world, 0, {0.4, 0.6});
  const BodyId body = world.add_free(part, collision_shape(part), shifted(0, 0, 0.32));
  double highest = 0, lowest = 1;
  for (int i = 0; i < 500; ++i) {
    world.step(kStep);
    const double z = world.pose(body).translation().z() - 0.02;  // of the lower apex
    lowest = std::min(lowest, z);
    if (world.velocity(body).z() > 0) highest = std::max(highest, z);
  }
  EXPECT_NEAR(highest, 0.36 * 0.3, 0.02 * 0.36 * 0.3);
  EXPECT_GT(lowest, -3e-3);
}

TEST(World, SlideEndsAfterSpeedSquaredOverTwoMuG) {
  for (const double friction : {0.25, 0.5}) {
    World world{PhysicsConfig{}};
    const Part part = example::box({0.08, 0.08, 0.01}, 2700, friction);
    add_slab(world, 0, {friction, 0});
    const BodyId body = world.add_free(part, collision_shape(part), shifted(0, 0, 0));
    run(world, 0.1);
    world.set_velocity(body, {1, 0, 0}, Eigen::Vector3d::Zero());
    const double start = world.pose(body).translation().x();
    run(world, 1.0);
    const double expected = 1 / (2 * friction * kGravity);
    EXPECT_NEAR(world.pose(body).translation().x() - start, expected, 0.015 * expected) << friction;
  }
}

TEST(World, SlipStartsAtTheAngleOfFriction) {
  const double friction = 0.4, limit = std::atan(friction), half_degree = std::numbers::pi / 360;
  for (const double angle : {limit - half_degree, limit + half_degree}) {
    World world{PhysicsConfig{}};
    const Part part = example::box({0.08, 0.08, 0.01}, 2700, friction);
    add_slab(world, angle, {friction, 0});
    const BodyId body = world.add_free(part, collision_shape(part), tilted(angle));
    run(world, 0.2);
    const Eigen::Vector3d before = world.pose(body).translation();
    run(world, 1.0);
    const double moved = (world.pose(body).translation() - before).norm();
    if (angle < limit)
      EXPECT_LT(moved, 2e-4);
    else  // s = g (sin a - mu cos a) t^2 / 2 and more, as it already moves at the start
      EXPECT_GT(moved, 0.5 * kGravity * (std::sin(angle) - friction * std::cos(angle)));
  }
}

TEST(World, FrictionOfUnequalMaterialsIsTheGeometricMean) {
  World world{PhysicsConfig{}};
  const Part part = example::box({0.08, 0.08, 0.01}, 2700, 0.8);
  add_slab(world, 0, {0.2, 0});
  const BodyId body = world.add_free(part, collision_shape(part), shifted(0, 0, 0));
  run(world, 0.1);
  world.set_velocity(body, {1, 0, 0}, Eigen::Vector3d::Zero());
  run(world, 1.0);
  EXPECT_NEAR(world.pose(body).translation().x(), 1 / (2 * 0.4 * kGravity), 0.02 / (2 * 0.4 * kGravity));
}

TEST(World, PartsRestAtTheMeshExactHeight) {
  for (const Part& part : {example::box({0.06, 0.04, 0.03}), example::ring()}) {
    World world{PhysicsConfig{}};
    add_slab(world, 0, {0.4, 0});
    const double bottom = bounding_box(part.envelope_P).min().z();
    const BodyId body = world.add_free(part, collision_shape(part), shifted(0, 0, 0.02 - bottom));
    SettleConfig config;
    ASSERT_TRUE(settle(world, config)) << part.name;
    EXPECT_NEAR(world.pose(body).translation().z(), -bottom, 0.2e-3) << part.name;
    EXPECT_GT(world.pose(body).linear()(2, 2), std::cos(0.005)) << part.name;  // flat; it may have turned
    EXPECT_FALSE(world.awake(body));
    EXPECT_LT(world.deepest_contact(), 0.1e-3);
  }
}

TEST(World, ThinSheetRestsAtItsHeightToo) {
  World world{PhysicsConfig{}};
  add_slab(world, 0, {0.4, 0});
  const Part part = example::box({0.06, 0.04, 0.0006}, 7860);
  const BodyId body = world.add_free(part, collision_shape(part), shifted(0, 0, 0.005));
  ASSERT_TRUE(settle(world, SettleConfig{}));
  EXPECT_NEAR(world.pose(body).translation().z(), 0, 0.2e-3);
}

TEST(World, MovedBodyPushesWithItsOwnSpeedAndReportsTheForce) {
  World world{PhysicsConfig{}};
  add_slab(world, 0, {0.4, 0});
  const Part part = example::box({0.05, 0.05, 0.05});
  const BodyId body = world.add_free(part, collision_shape(part), shifted(0.021, -0.025, 0));
  const Primitive pusher = Primitive::box({0.04, 0.04, 0.004}, shifted(0, 0, 0.01));
  const BodyId moved = world.add_moved({&pusher, 1}, Pose::Identity(), {0.0, 0});
  double force = 0;
  for (int i = 1; i <= 1000; ++i) {
    world.move_to(moved, shifted(0.2 * i * kStep, 0, 0));
    world.step(kStep);
    for (const World::BodyContact& contact : world.contacts(moved)) force += i > 500 ? contact.force / 500 : 0;
  }
  EXPECT_NEAR(world.pose(moved).translation().x(), 0.2, 1e-12);
  EXPECT_NEAR(world.pose(body).translation().x(), 0.22, 0.5e-3);  // its face keeps touching the pusher's
  EXPECT_NEAR(force, 0.4 * part.mass.mass * kGravity, 0.05 * 0.4 * part.mass.mass * kGravity);
}

TEST(World, IgnoredPairsPassThroughEachOther) {
  World world{PhysicsConfig{}};
  const BodyId slab = add_slab(world, 0, {0.4, 0});
  const Part part = example::box({0.05, 0.05, 0.05});
  const BodyId body = world.add_free(part, collision_shape(part), shifted(0, 0, 0.001));
  world.set_collides(slab, body, false);
  run(world, 0.2);
  EXPECT_NEAR(world.velocity(body).z(), -kGravity * 0.2, 1e-6);
}

TEST(World, OverlapOfMovedAndFixedBodiesIsMeasured) {
  World world{PhysicsConfig{}};
  const BodyId slab = add_slab(world, 0, {0.4, 0});
  const Primitive cube = Primitive::box({0.1, 0.1, 0.1});
  const BodyId moved = world.add_moved({&cube, 1}, shifted(0, 0, 0.045), {0.4, 0});
  EXPECT_NEAR(world.overlap(moved, slab), 0.005, 1e-4);
  world.teleport(moved, shifted(0, 0, 0.06));
  EXPECT_EQ(world.overlap(moved, slab), 0);
}

}  // namespace
}  // namespace binpick

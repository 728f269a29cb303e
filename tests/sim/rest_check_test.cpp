// A heap that is said to be at rest, kept awake and watched.
#include <gtest/gtest.h>

#include "example_parts.hpp"
#include "sim/drop.hpp"
#include "sim/rest_check.hpp"

namespace binpick {
namespace {

struct Sleeper {
  World world{PhysicsConfig{}};
  Part part = example::box({0.06, 0.04, 0.02});
  CollisionShape shape = collision_shape(part);
  BodyId body;

  /// The box with its corner at the origin, put to sleep as it stands.
  explicit Sleeper(double tilt) {
    const Primitive slab = example::slab();
    world.add_fixed(std::span(&slab, 1), Pose::Identity(), {0.4, 0});
    const Eigen::AngleAxisd turn(-tilt, Eigen::Vector3d::UnitY());
    body = world.add_free(part, shape, Pose(turn));
    world.step(1e-3);
    world.put_to_sleep(body);
  }
};

TEST(RestCheck, ABoxOnItsFaceStaysAndKeepsItsBits) {
  Sleeper sleeper(0);
  const std::uint64_t before = sleeper.world.state_hash();
  const WakeReport report = wake_and_watch(sleeper.world, std::span(&sleeper.body, 1), 2.0);
  EXPECT_LT(report.largest_motion, kMoved);
  EXPECT_LT(report.energy, 1e-6);
  EXPECT_EQ(report.moved_share, 0);
  EXPECT_EQ(sleeper.world.state_hash(), before);
  EXPECT_FALSE(sleeper.world.awake(sleeper.body));
}

TEST(RestCheck, ABoxAsleepOnItsEdgeFallsAndIsPutBack) {
  Sleeper sleeper(0.3);  // well inside of the balance at atan(2 / 6): it falls back on its long face
  const std::uint64_t before = sleeper.world.state_hash();
  const WakeReport report = wake_and_watch(sleeper.world, std::span(&sleeper.body, 1), 2.0);
  EXPECT_GT(report.largest_motion, 0.25 * sleeper.world.bounding_radius(sleeper.body));
  EXPECT_EQ(report.moved_share, 1);
  EXPECT_EQ(sleeper.world.state_hash(), before);
}

TEST(RestCheck, EnergyIsThatOfTheMotion) {
  World world{PhysicsConfig{}};
  const Part part = example::box({0.06, 0.04, 0.02});
  const BodyId body = world.add_free(part, collision_shape(part), Pose::Identity());
  const double m = part.mass.mass, spin = 3;
  world.set_velocity(body, {0, 2, 0}, {0, 0, spin});
  const double inertia_z = m * (0.06 * 0.06 + 0.04 * 0.04) / 12;
  EXPECT_NEAR(world.kinetic_energy(body), m * 4 / 2 + inertia_z * spin * spin / 2, 1e-9);
  world.set_velocity(body, {0, 0, 0}, {0, 0, 0});
  for (int k = 0; k < 100; ++k) world.step(1e-3);  // a tenth of a second of free fall
  EXPECT_NEAR(world.kinetic_energy(body), m * 0.981 * 0.981 / 2, 1e-6);
}

}  // namespace
}  // namespace binpick

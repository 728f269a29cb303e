// The bare Bullet world beside ours: the same bits, or it would not be the same heap that is timed.
#include "sim/bare_bullet.hpp"

#include <gtest/gtest.h>

#include "sim/drop.hpp"
#include "sim/world_impl.hpp"
#include "tests/sim/example_parts.hpp"

namespace binpick {
namespace {

DropResult drop(World& world, const BinSpec& bin) {
  const Part ring = example::ring(), box = example::box({0.03, 0.04, 0.05});
  const CollisionShape ring_shape = collision_shape(ring), box_shape = collision_shape(box);
  const std::vector<DropItem> items = {{&ring, &ring_shape, 0}, {&box, &box_shape, 1}, {&ring, &ring_shape, 0}};
  world.add_fixed(bin_boxes(bin, 0.05), Pose::Identity(), {bin.friction, bin.restitution});
  return drop_parts(world, items, bin, Pose::Identity(), DropConfig{}, SettleConfig{}, Seed{3}.child("drop"));
}

TEST(BareBullet, FollowsADropToTheLastBit) {
  World watched{PhysicsConfig{}}, alone{PhysicsConfig{}};
  const BinSpec bin;
  double clock = 0;
  const BareBullet bare(watched, [&] { return clock += 1; });
  EXPECT_TRUE(drop(watched, bin).settled);
  const BareBullet::Report report = bare.report();
  EXPECT_GT(report.steps, 300u);
  EXPECT_NEAR(report.simulated, watched.time(), 1e-9);
  EXPECT_EQ(report.different, 0u);
  // One reading before and one after each step of the bare world; ours is read as often, and as bodies come and go.
  EXPECT_EQ(report.bare, static_cast<double>(report.steps));
  EXPECT_GE(report.ours, 2.0 * static_cast<double>(report.steps));
  EXPECT_LT(report.ours, 2.0 * static_cast<double>(report.steps) + 30);
  drop(alone, bin);
  EXPECT_EQ(watched.state_hash(), alone.state_hash()) << "being watched changed the heap";
}

TEST(BareBullet, NoticesAnotherSetting) {
  World world{PhysicsConfig{}};
  const BareBullet bare(world, [] { return 0.0; });
  world.impl().world->getSolverInfo().m_warmstartingFactor = 0.8;  // after the bare world took the settings over
  drop(world, BinSpec{});
  EXPECT_GT(bare.report().different, 0u);
}

}  // namespace
}  // namespace binpick

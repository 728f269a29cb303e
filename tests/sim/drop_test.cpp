// Heaps: at rest, inside the bin, without deep contacts, and the same for the same seed.
#include <gtest/gtest.h>

#include "example_parts.hpp"
#include "sim/bin.hpp"
#include "sim/drop_stages.hpp"
#include "sim/rest_check.hpp"

namespace binpick {
namespace {

struct Heap {
  DropResult result;
  std::uint64_t hash = 0;
  std::vector<Pose> poses;
};

Heap dropped(const Part& part, int count, Seed seed, const BinSpec& bin = {}, const DropConfig& drop = {},
             const SettleConfig& settle = {}) {
  const CollisionShape shape = collision_shape(part);
  World world{PhysicsConfig{}};
  const Pose X_WB(Eigen::Translation3d(0.5, 0.1, 0.02));
  add_bin(world, bin, X_WB);
  const std::vector<DropItem> items(static_cast<std::size_t>(count), {&part, &shape, 0});
  Heap heap;
  heap.result = drop_parts(world, items, bin, X_WB, drop, settle, seed);
  const SolidProbe probe = probe_of(part);
  check_rest(world, bin, X_WB, std::span(&probe, 1), settle, heap.result);
  heap.hash = world.state_hash();
  for (const BodyId body : heap.result.bodies) heap.poses.push_back(world.pose(body));
  return heap;
}

TEST(Drop, TenRingsComeToRestInsideTheBin) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Heap heap = dropped(example::ring(), 10, Seed{seed});
    EXPECT_TRUE(heap.result.settled) << "seed " << seed;
    EXPECT_TRUE(heap.result.escaped.empty()) << "seed " << seed;
    EXPECT_LT(heap.result.worst_penetration, 1e-3) << "seed " << seed;
    EXPECT_LT(heap.result.woken.largest_motion, 1e-3) << "seed " << seed;
    EXPECT_LT(heap.result.woken.energy, 1e-6) << "seed " << seed;
    for (const Pose& X_WP : heap.poses) EXPECT_GT(X_WP.translation().z(), 0.02 + 0.0075) << "seed " << seed;
  }
}

TEST(Drop, PartsOfADenseRainFallNoFartherThanStated) {
  const Part part = example::ring();
  const CollisionShape shape = collision_shape(part);
  World world{PhysicsConfig{}};
  const BinSpec bin;
  add_bin(world, bin, Pose::Identity());
  DropConfig drop;
  drop.interval = 0.02;  // s: a part is still slow and in mid-air when the next is due
  const std::vector<DropItem> items(20, {&part, &shape, 0});
  const double radius = part.diameter / 2, heap = 0.15;  // m: twenty rings lie no higher
  const auto bodies = rain_parts(world, items, bin, Pose::Identity(), drop, Seed{9});
  const double late = world.velocity(bodies.back()).norm(), most = std::sqrt(2 * 9.81 * (drop.height + heap));
  EXPECT_NEAR(late, std::sqrt(2 * 9.81 * drop.height), 0.1);
  for (const BodyId body : bodies) {
    EXPECT_LT(world.pose(body).translation().z(), heap + drop.height + 2 * radius);
    EXPECT_LT(world.velocity(body).norm(), most);
  }
}

TEST(Drop, AHeapThatMovesOnWhenWokenIsNotSettledAndSaysSo) {
  SettleConfig strict;
  strict.wake_motion = 1e-9;  // no solver rests so still
  const Heap heap = dropped(example::ring(), 6, Seed{77}, {}, {}, strict);
  EXPECT_FALSE(heap.result.settled);
  EXPECT_NE(heap.result.unsettled.find("woken"), std::string::npos) << heap.result.unsettled;
}

TEST(Drop, LookingAtAHeapDoesNotMoveIt) {
  SettleConfig believed;
  believed.wake_time = 0;
  const Heap watched = dropped(example::ring(), 6, Seed{77}),
             unseen = dropped(example::ring(), 6, Seed{77}, {}, {}, believed);
  ASSERT_TRUE(watched.result.settled && unseen.result.settled);
  EXPECT_GT(watched.result.woken.largest_motion, 0);
  EXPECT_EQ(unseen.result.woken.largest_motion, 0);
  EXPECT_EQ(watched.hash, unseen.hash);
}

TEST(Drop, SameSeedGivesTheSameBits) {
  const Heap first = dropped(example::ring(), 6, Seed{77}), second = dropped(example::ring(), 6, Seed{77});
  EXPECT_EQ(first.hash, second.hash);
  EXPECT_NE(first.hash, dropped(example::ring(), 6, Seed{78}).hash);
}

TEST(Drop, OneBoxLiesOnAFace) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Heap heap = dropped(example::box({0.06, 0.05, 0.04}), 1, Seed{seed});
    ASSERT_TRUE(heap.result.settled) << "seed " << seed;
    const Eigen::Vector3d up = heap.poses[0].linear().transpose() * Eigen::Vector3d::UnitZ();
    EXPECT_GT(up.cwiseAbs().maxCoeff(), std::cos(0.0175)) << "seed " << seed;
  }
}

TEST(Drop, AReleasedPartDoesNotDependOnThoseAfterIt) {
  // In a wide bin the first of several parts rarely meets the others: its place follows from its own stream only.
  BinSpec wide;
  wide.inner_size = {4, 4, 0.2};
  DropConfig drop;
  drop.spin = 0;
  drop.interval = 1.5;
  const Heap alone = dropped(example::box({0.1, 0.1, 0.01}), 1, Seed{5}, wide, drop);
  const Heap three = dropped(example::box({0.1, 0.1, 0.01}), 3, Seed{5}, wide, drop);
  EXPECT_LT((alone.poses[0].translation() - three.poses[0].translation()).norm(), 1e-3);
  EXPECT_GT((three.poses[1].translation() - three.poses[0].translation()).norm(), 0.1);
}

TEST(Drop, OverfullBinIsAnOutcome) {
  BinSpec tiny;
  tiny.inner_size = {0.12, 0.12, 0.03};
  const Heap heap =
      dropped(example::ring(), 16, Seed{3}, tiny);  // stacked, they would reach twice its rim and a diameter
  EXPECT_FALSE(heap.result.settled && heap.result.escaped.empty());
}

TEST(Drop, BoxesOfAnyShapeRest) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Heap heap = dropped(example::box({0.09, 0.06, 0.02}), 12, Seed{seed});
    EXPECT_TRUE(heap.result.settled && heap.result.escaped.empty()) << "seed " << seed;
    EXPECT_LT(heap.result.worst_penetration, 1e-3) << "seed " << seed;
  }
}

TEST(Drop, PartsLieBetweenLeaningWallsAndDividers) {
  BinSpec tote;
  tote.inner_size = {0.4, 0.3, 0.15};
  tote.draft = 0.15;
  tote.dividers_x = {0.02};
  tote.divider_height = 0.1;
  const Part part = example::box({0.07, 0.05, 0.03});
  const SolidProbe probe = probe_of(part);
  const std::vector<Primitive> boxes = bin_boxes(tote, kThickWall);
  int left = 0, over_the_floor = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Heap heap = dropped(part, 16, Seed{seed}, tote);
    EXPECT_TRUE(heap.result.settled && heap.result.escaped.empty()) << "seed " << seed;
    for (const Pose& X_WP : heap.poses) {
      const Pose X_BP = Pose(Eigen::Translation3d(0.5, 0.1, 0.02)).inverse() * X_WP;
      EXPECT_LT(probe.deepest_in(boxes, X_BP), 0.5e-3) << "seed " << seed;
      left += X_BP.translation().x() < 0.02;
      const Eigen::Vector2d beyond = X_BP.translation().head<2>().cwiseAbs() - tote.half_at(0);
      over_the_floor += beyond.maxCoeff() < -0.02;
    }
  }
  EXPECT_GT(left, 8);
  EXPECT_LT(left, 24);
  EXPECT_LT(over_the_floor, 32);  // some lie on a leaning wall
}

}  // namespace
}  // namespace binpick

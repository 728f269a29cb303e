#include "core/random.hpp"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace binpick {
namespace {

// The known answers published with Random123 (kat_vectors, philox4x32-10).
TEST(Random, PhiloxGivesThePublishedVectors) {
  r123::Philox4x32 philox;
  using Counter = r123::Philox4x32::ctr_type;
  using Key = r123::Philox4x32::key_type;
  EXPECT_EQ(philox(Counter{{0, 0, 0, 0}}, Key{{0, 0}}), (Counter{{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}}));
  const std::uint32_t f = 0xffffffff;
  EXPECT_EQ(philox(Counter{{f, f, f, f}}, Key{{f, f}}), (Counter{{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}}));
  EXPECT_EQ(philox(Counter{{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}}, Key{{0xa4093822, 0x299f31d0}}),
            (Counter{{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}}));
}

TEST(Random, StreamOfKeyZeroStartsWithTheFirstVector) {
  Rng rng(0);
  EXPECT_EQ(rng.next_u32(), 0x6627e8d5u);
  EXPECT_EQ(rng.next_u32(), 0xe169c58du);
  EXPECT_EQ(rng.next_u32(), 0xbc57ac4cu);
  EXPECT_EQ(rng.next_u32(), 0x9b00dbd8u);
}

TEST(Random, ItemsDoNotDependOnTheOrderOfVisits) {
  const Rng stream = Seed{7}.child("pixels").rng();
  std::vector<double> forward(100), backward(100);
  for (std::size_t i = 0; i < 100; ++i) forward[i] = stream.at(i).uniform();
  for (std::size_t i = 100; i-- > 0;) backward[i] = stream.at(i).uniform();
  EXPECT_EQ(forward, backward);
  EXPECT_EQ(std::set<double>(forward.begin(), forward.end()).size(), 100u);
}

TEST(Random, ChildrenDifferByNameAndIndex) {
  std::set<std::uint64_t> keys;
  for (const char* name : {"drop", "sensor", "estimator", "d", ""})
    for (std::uint64_t index = 0; index < 200; ++index) keys.insert(Seed{1}.child(name, index).key);
  EXPECT_EQ(keys.size(), 1000u);
  EXPECT_EQ(Seed{1}.child("drop", 3), Seed{1}.child("drop", 3));
  EXPECT_NE(Seed{1}.child("drop"), Seed{2}.child("drop"));
}

// Means within five standard errors of n draws: sqrt(1/12/n) for uniform, 1/sqrt(n) for normal.
TEST(Random, MomentsOfUniformAndNormal) {
  Rng rng = Seed{11}.child("moments").rng();
  const int n = 200000;
  double sum = 0, normal_sum = 0, normal_square = 0, normal_fourth = 0;
  for (int i = 0; i < n; ++i) {
    const double u = rng.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    const double x = rng.normal();
    normal_sum += x, normal_square += x * x, normal_fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / n, 0.5, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(normal_sum / n, 0, 5 / std::sqrt(double(n)));
  EXPECT_NEAR(normal_square / n, 1, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(normal_fourth / n, 3, 5 * std::sqrt(96.0 / n));
}

TEST(Random, BelowIsUniform) {
  Rng rng = Seed{12}.child("below").rng();
  std::vector<int> counts(7);
  for (int i = 0; i < 70000; ++i) ++counts[rng.below(7)];
  for (const int count : counts) EXPECT_NEAR(count, 10000, 5 * std::sqrt(10000 * 6.0 / 7));
}

// A uniform rotation turns any fixed vector into a uniform direction: every component has mean 0 and variance 1/3.
TEST(Random, RotationsAreUniform) {
  Rng rng = Seed{13}.child("rotation").rng();
  const int n = 50000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), square = Eigen::Vector3d::Zero();
  for (int i = 0; i < n; ++i) {
    const Eigen::Quaterniond q = rng.rotation();
    ASSERT_NEAR(q.norm(), 1, 1e-12);
    const Eigen::Vector3d v = q * Eigen::Vector3d(0.6, 0, 0.8);
    sum += v, square += v.cwiseAbs2();
  }
  EXPECT_LT((sum / n).cwiseAbs().maxCoeff(), 5 * std::sqrt(1.0 / 3 / n));
  EXPECT_LT((square / n - Eigen::Vector3d::Constant(1.0 / 3)).cwiseAbs().maxCoeff(), 5 * std::sqrt(4.0 / 45 / n));
}

TEST(Random, ShuffleKeepsEveryItemAndMovesTheFirstEverywhere) {
  std::vector<int> seen(5);
  for (std::uint64_t k = 0; k < 500; ++k) {
    std::vector<int> items = {0, 1, 2, 3, 4};
    Seed{14}.child("shuffle", k).rng().shuffle(items);
    ++seen[std::find(items.begin(), items.end(), 0) - items.begin()];
    std::sort(items.begin(), items.end());
    ASSERT_EQ(items, (std::vector<int>{0, 1, 2, 3, 4}));
  }
  for (const int count : seen) EXPECT_NEAR(count, 100, 5 * std::sqrt(80.0));
}

}  // namespace
}  // namespace binpick

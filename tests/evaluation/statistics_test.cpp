// Intervals and quantiles against published and hand-made figures.
#include "evaluation/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace binpick {
namespace {

// The paper's 48 of 50: 86.5 to 98.9 %.
TEST(Wilson, FortyEightOfFifty) {
  const Interval interval = wilson_interval(48, 50);
  EXPECT_NEAR(interval.low, 0.865, 0.0005);
  EXPECT_NEAR(interval.high, 0.989, 0.0005);
}

// Brown, Cai and DasGupta, Statistical Science 2001: with no hit the Wilson interval is [0, z^2 / (n + z^2)].
TEST(Wilson, AllAndNone) {
  const double z = 1.959963984540054;
  EXPECT_EQ(wilson_interval(0, 20).low, 0);
  EXPECT_NEAR(wilson_interval(0, 20).high, z * z / (20 + z * z), 1e-12);
  EXPECT_EQ(wilson_interval(20, 20).high, 1);
  EXPECT_NEAR(wilson_interval(20, 20).low, 20 / (20 + z * z), 1e-12);
  EXPECT_EQ(wilson_interval(0, 0).low, 0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1);
}

// 95 of 100: 88.8 to 97.9 %; 950 of 1000: 93.5 to 96.2 %.
TEST(Wilson, NarrowsWithTheSample) {
  EXPECT_NEAR(wilson_interval(95, 100).low, 0.888, 0.0005);
  EXPECT_NEAR(wilson_interval(95, 100).high, 0.978, 0.0006);
  EXPECT_NEAR(wilson_interval(950, 1000).low, 0.935, 0.0005);
  EXPECT_GT(wilson_interval(95, 100, 0.99).high, wilson_interval(95, 100).high);
}

// Clopper and Pearson 1934. The paper's 48 of 50: 86.3 to 99.5 %; 95 of 100: 88.7 to 98.4 %; 950 of 1000: 93.5 to 96.3
// %. No failure in n: the lower bound b solves b^n = 2.5 %.
TEST(ClopperPearson, PublishedAndByHand) {
  EXPECT_NEAR(clopper_pearson(48, 50).low, 0.863, 0.0005);
  EXPECT_NEAR(clopper_pearson(48, 50).high, 0.995, 0.0005);
  EXPECT_NEAR(clopper_pearson(95, 100).low, 0.887, 0.0005);
  EXPECT_NEAR(clopper_pearson(95, 100).high, 0.984, 0.0005);
  EXPECT_NEAR(clopper_pearson(950, 1000).high, 0.963, 0.0005);
  EXPECT_NEAR(clopper_pearson(30, 30).low, std::pow(0.025, 1.0 / 30), 1e-12);
  EXPECT_EQ(clopper_pearson(30, 30).high, 1);
  EXPECT_EQ(clopper_pearson(0, 30).low, 0);
  EXPECT_EQ(clopper_pearson(0, 0).high, 1);
}

// "Zero failures in n": less than 1 % at 95 % one-sided needs 299, less than 0.1 % needs 2,995.
TEST(ClopperPearson, ZeroFailures) {
  EXPECT_LT(clopper_pearson(0, 299, 0.90).high, 0.01);
  EXPECT_GT(clopper_pearson(0, 298, 0.90).high, 0.01);
  EXPECT_LT(clopper_pearson(0, 2995, 0.90).high, 0.001);
  EXPECT_GT(clopper_pearson(0, 2994, 0.90).high, 0.001);
}

TEST(Binomial, ByHand) {
  EXPECT_DOUBLE_EQ(binomial_at_least(2, 3, 0.5), 0.5);
  EXPECT_NEAR(binomial_at_least(3, 3, 0.1), 0.001, 1e-15);
  EXPECT_EQ(binomial_at_least(0, 3, 0.1), 1);
  EXPECT_EQ(binomial_at_least(4, 3, 0.9), 0);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
}

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({4, 1, 2, 3}, 0.5), 2.5);
  EXPECT_EQ(quantile({1, 2}, 0), 1);
  EXPECT_EQ(quantile({1, 2}, 1), 2);
  EXPECT_NEAR(quantile({10, 20, 30, 40, 50}, 0.95), 48, 1e-12);
  EXPECT_EQ(quantile({7}, 0.95), 7);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_EQ(mean(std::vector<double>{1, 2, 6}), 3);
}

TEST(ClusterBootstrap, FallsBackToWilson) {
  const std::vector<ClusterCount> one = {{7, 10}}, sure = {{5, 5}, {3, 3}}, none = {{0, 5}, {0, 3}};
  EXPECT_EQ(cluster_bootstrap(one, Seed{1}).low, wilson_interval(7, 10).low);
  EXPECT_EQ(cluster_bootstrap(sure, Seed{1}).low, wilson_interval(8, 8).low);
  EXPECT_EQ(cluster_bootstrap(none, Seed{1}).high, wilson_interval(0, 8).high);
  EXPECT_EQ(cluster_bootstrap({}, Seed{1}).low, 0);
  EXPECT_EQ(cluster_bootstrap({}, Seed{1}).high, 1);
}

TEST(ClusterBootstrap, SameSeedSameAnswerAndEmptyPilesSayNothing) {
  const std::vector<ClusterCount> piles = {{9, 10}, {10, 10}, {7, 10}, {10, 10}};
  std::vector<ClusterCount> padded = piles;
  padded.push_back({0, 0});
  const Interval a = cluster_bootstrap(piles, Seed{5}), b = cluster_bootstrap(piles, Seed{5}),
                 c = cluster_bootstrap(padded, Seed{5});
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_EQ(a.low, c.low);
  EXPECT_LE(a.low, 0.9);
  EXPECT_GE(a.high, 0.9);
  EXPECT_LT(a.low, a.high);
}

// Two piles, one all hits and one none: a resample is 0, 1/2 or 1 with probability 1/4, 1/2, 1/4.
TEST(ClusterBootstrap, TwoOppositePiles) {
  const std::vector<ClusterCount> piles = {{10, 10}, {0, 10}};
  const Interval wide = cluster_bootstrap(piles, Seed{2});
  EXPECT_EQ(wide.low, 0);
  EXPECT_EQ(wide.high, 1);
  // At a confidence of 0.2 the resamples give 0.5 alone (32 % .. 68 % lie inside the middle half): Wilson's interval
  // rules. Two piles are worth one trial, and Student's quantile of one degree of freedom is a tangent.
  const Interval narrow = cluster_bootstrap(piles, Seed{2}, 4000, 0.2);
  EXPECT_NEAR(narrow.low, 0.5 - 0.5 * std::sin(0.1 * M_PI), 1e-9);
  EXPECT_NEAR(narrow.high, 0.5 + 0.5 * std::sin(0.1 * M_PI), 1e-9);
}

// Piles whose picks stand and fall together: the interval must hold the true rate about 95 times in 100, where an
// interval that takes the picks for independent does so far more rarely.
TEST(ClusterBootstrap, CoversWhereIndependentPicksDoNot) {
  constexpr int kExperiments = 300, kPiles = 60, kPicks = 10;
  constexpr double kTruth = 0.7;  // a pile is good (9 of 10) with probability 3/4, else bad (1 of 10)
  int covered = 0, wilson_covered = 0;
  for (std::uint64_t e = 0; e < kExperiments; ++e) {
    Rng rng = Seed{20261124}.child("coverage").rng().at(e);
    std::vector<ClusterCount> piles;
    std::size_t hits = 0;
    for (int k = 0; k < kPiles; ++k) {
      const double rate = rng.uniform() < 0.75 ? 0.9 : 0.1;
      int pile_hits = 0;
      for (int i = 0; i < kPicks; ++i) pile_hits += rng.uniform() < rate ? 1 : 0;
      piles.push_back({static_cast<double>(pile_hits), kPicks});
      hits += static_cast<std::size_t>(pile_hits);
    }
    const Interval interval = cluster_bootstrap(piles, Seed{e}, 500);
    const Interval naive = wilson_interval(hits, kPiles * kPicks);
    covered += interval.low <= kTruth && kTruth <= interval.high ? 1 : 0;
    wilson_covered += naive.low <= kTruth && kTruth <= naive.high ? 1 : 0;
  }
  // 300 draws at 95 %: three standard deviations are 3.8 points, and the percentile bootstrap of few piles is a little
  // short.
  EXPECT_GE(covered, 0.90 * kExperiments) << covered;
  EXPECT_LE(covered, 0.99 * kExperiments) << covered;
  EXPECT_LE(wilson_covered, 0.80 * kExperiments) << wilson_covered;
}

}  // namespace
}  // namespace binpick

// Paired tests against values worked by hand, published examples and their own defining properties.
#include "evaluation/paired_tests.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace binpick {
namespace {

// Of eight coins at least seven heads: (8 + 1) / 256. Bentur et al. 2009 as in Fagerland, Lydersen and Laake
// (Statistics in Medicine 33, 2014): 1 and 7 of 21 pairs differ, exact two-sided 0.0703.
TEST(McNemar, ByHand) {
  EXPECT_DOUBLE_EQ(mcnemar_worse({1, 7, 1, 12}), 9.0 / 256);
  EXPECT_NEAR(2 * mcnemar_worse({1, 7, 1, 12}), 0.0703, 0.00005);
  EXPECT_DOUBLE_EQ(mcnemar_worse({0, 1, 7, 0}), 255.0 / 256);
  EXPECT_EQ(mcnemar_worse({30, 0, 0, 2}), 1);
  EXPECT_EQ(mcnemar_worse({30, 0, 4, 2}), 1);
}

// All that differ are losses: how many are needed to reject (reference: 7, 10 and 14 at 1e-2, 1e-3 and 1e-4).
TEST(McNemar, PureLosses) {
  for (const auto& [alpha, needed] : {std::pair{1e-2, 7}, {1e-3, 10}, {1e-4, 14}}) {
    EXPECT_LE(mcnemar_worse({100, static_cast<std::size_t>(needed), 0, 0}), alpha);
    EXPECT_GT(mcnemar_worse({100, static_cast<std::size_t>(needed) - 1, 0, 0}), alpha);
  }
}

// The same example: -0.517 to -0.026 in the direction of (lost 1, won 7).
TEST(Tango, PublishedExample) {
  const Interval interval = tango_interval({1, 1, 7, 12});
  EXPECT_NEAR(interval.low, -0.517, 0.0005);
  EXPECT_NEAR(interval.high, -0.026, 0.0005);
  const Interval other_way = tango_interval({1, 7, 1, 12});
  EXPECT_NEAR(other_way.low, -interval.high, 1e-12);
  EXPECT_NEAR(other_way.high, -interval.low, 1e-12);
}

// Yang, Sun and Hardin (Statistics in Medicine 32, 2013): the bounds are roots of a polynomial of fourth degree.
TEST(Tango, BoundsAreRootsOfThePublishedPolynomial) {
  const double g = std::pow(normal_quantile(0.975), 2);
  const PairedVerdicts examples[] = {{40, 6, 2, 12}, {90, 12, 9, 189}, {0, 40, 20, 100}, {250, 30, 3, 17}};
  for (const PairedVerdicts& v : examples) {
    const double n = static_cast<double>(v.total()), s = static_cast<double>(v.lost + v.won);
    const double d = static_cast<double>(v.lost) - static_cast<double>(v.won);
    const double m0 = n * n * std::pow(n / g + 1, 2), m1 = -n * d * (n / g + 1) * (4 * n / g + 1);
    const double m2 = 2 * n * d * d * (3 * n / g + 2) / g - n * n * (s / g + 1);
    const double m3 = n * d * (2 * s / g + 1) - d * d * d * (4 * n / g + 1) / g, m4 = d * d * (d * d / g - s) / g;
    const Interval interval = tango_interval(v);
    for (const double x : {interval.low, interval.high}) {
      EXPECT_NEAR((((m0 * x + m1) * x + m2) * x + m3) * x + m4, 0, 1e-9 * m0) << v.lost << " lost, " << v.won << " won";
    }
    EXPECT_LT(interval.low, d / n);
    EXPECT_GT(interval.high, d / n);
  }
}

TEST(Tango, EdgesOfTheTable) {
  EXPECT_EQ(tango_interval({0, 0, 0, 0}).low, -1);
  EXPECT_EQ(tango_interval({0, 0, 0, 0}).high, 1);
  EXPECT_EQ(tango_interval({0, 12, 0, 0}).high, 1);
  EXPECT_EQ(tango_interval({0, 0, 12, 0}).low, -1);
  // No pile differs: the score at loss d is n d^2 = z^2 d (1 - d), so the bounds are +- z^2 / (n + z^2).
  const double z = normal_quantile(0.975), bound = z * z / (50 + z * z);
  EXPECT_NEAR(tango_interval({30, 0, 0, 20}).high, bound, 1e-9);
  EXPECT_NEAR(tango_interval({30, 0, 0, 20}).low, -bound, 1e-9);
}

// Fisher's sign patterns of 1, 2, 3: sums 6 4 2 0 0 -2 -4 -6.
TEST(SignFlip, EveryPatternByHand) {
  const std::vector<double> all_worse = {1, 2, 3}, one_better = {-1, 2, 3}, level = {1, 2, -3}, better = {-1, -2, -3};
  EXPECT_DOUBLE_EQ(sign_flip_worse(all_worse, Seed{1}), 1.0 / 8);
  EXPECT_DOUBLE_EQ(sign_flip_worse(one_better, Seed{1}), 2.0 / 8);
  EXPECT_DOUBLE_EQ(sign_flip_worse(level, Seed{1}), 5.0 / 8);
  EXPECT_DOUBLE_EQ(sign_flip_worse(better, Seed{1}), 1);
  const std::vector<double> padded = {0, 1, 0, 2, 3, 0};
  EXPECT_DOUBLE_EQ(sign_flip_worse(padded, Seed{1}), 1.0 / 8);
  EXPECT_EQ(sign_flip_worse(std::vector<double>(30, 0.0), Seed{1}), 1);
}

// Darwin's fifteen pairs of Zea mays, Fisher, The Design of Experiments (1935), section 21: of 32768 patterns 863 reach
// the observed sum of 314 (1726 either way).
TEST(SignFlip, DarwinsMaize) {
  const std::vector<double> eighths = {49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48};
  EXPECT_DOUBLE_EQ(sign_flip_worse(eighths, Seed{1}), 863.0 / 32768);
}

// With losses of one size it is the sign test, and so McNemar's.
TEST(SignFlip, OfOneSizeIsMcNemar) {
  std::vector<double> losses(11, 0.25);
  losses.insert(losses.end(), 4, -0.25);
  EXPECT_NEAR(sign_flip_worse(losses, Seed{1}), mcnemar_worse({0, 11, 4, 0}), 1e-12);
}

TEST(SignFlip, DrawnAgreesWithExact) {
  const std::vector<double> eighths = {49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48};
  SignFlipEffort drawn;
  drawn.exact_up_to = 0;
  drawn.enough_beyond = drawn.draws;
  const double p = 863.0 / 32768, deviation = std::sqrt(p / static_cast<double>(drawn.draws));
  EXPECT_NEAR(sign_flip_worse(eighths, Seed{3}, drawn), p, 4 * deviation);
  EXPECT_EQ(sign_flip_worse(eighths, Seed{3}, drawn), sign_flip_worse(eighths, Seed{3}, drawn));
  EXPECT_NE(sign_flip_worse(eighths, Seed{3}, drawn), sign_flip_worse(eighths, Seed{4}, drawn));
  // Stopped early it is coarser: 200 patterns beyond are a relative deviation of 7 %.
  drawn.enough_beyond = 200;
  EXPECT_NEAR(sign_flip_worse(eighths, Seed{3}, drawn), p, 4 * 0.07 * p);
}

// A sum that no drawn pattern reaches is still one pattern: p is never 0.
TEST(SignFlip, NeverZero) {
  const std::vector<double> losses(60, 1.0);
  EXPECT_EQ(sign_flip_worse(losses, Seed{1}, {16, 999, 20}), 1e-3);
}

// Holm 1979. By hand: 4 * 0.01, 3 * 0.02, 2 * 0.03, then 0.04 raised to its predecessor.
TEST(Holm, ByHand) {
  const std::vector<double> p = {0.04, 0.01, 0.03, 0.02};
  const std::vector<double> adjusted = holm(p);
  EXPECT_DOUBLE_EQ(adjusted[1], 0.04);
  EXPECT_DOUBLE_EQ(adjusted[3], 0.06);
  EXPECT_DOUBLE_EQ(adjusted[2], 0.06);
  EXPECT_DOUBLE_EQ(adjusted[0], 0.06);
  EXPECT_DOUBLE_EQ(holm(std::vector<double>{0.6, 0.7})[0], 1);
  EXPECT_TRUE(holm({}).empty());
}

// A/A: 40 piles of correlated picks with equal chances before and after, a level of 5 %.
// A pile is good or bad for both versions; inside it every pick is a coin of its own.
TEST(SignFlip, KeepsItsLevelOnEqualVersions) {
  constexpr int kRuns = 2000;
  constexpr double kAlpha = 0.05;
  int alarms = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    Rng rng = Seed{20261130}.child("a_a").rng().at(run);
    std::vector<double> losses;
    for (int pile = 0; pile < 40; ++pile) {
      const double rate = rng.uniform() < 0.8 ? 0.98 : 0.6;
      int loss = 0;
      for (int pick = 0; pick < 10; ++pick) loss += (rng.uniform() < rate ? 1 : 0) - (rng.uniform() < rate ? 1 : 0);
      losses.push_back(loss);
    }
    alarms += sign_flip_worse(losses, Seed{run}, {16, 2000, 200}) <= kAlpha ? 1 : 0;
  }
  // Binomial: 100 expected, deviation 9.7. Ties make the test a little conservative.
  EXPECT_LE(alarms, 135);
  EXPECT_GE(alarms, 50);
}

}  // namespace
}  // namespace binpick

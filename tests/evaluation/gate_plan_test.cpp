// The sequential gate: what each look spends, when a verdict is certain, and how it does on made-up piles.
#include "evaluation/gate_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace binpick {
namespace {

// Piles of ten picks that succeed with `rate`; good and bad piles are the same for all versions of one `pile_stream`.
PileSet simulated(std::uint64_t run, const std::string& version, double rate, std::size_t count) {
  PileSet set;
  set.name = version;
  for (std::size_t i = 0; i < count; ++i) {
    Rng pile = Seed{run}.child("pile", i).rng(), luck = Seed{run}.child(version, i).rng();
    const double here = rate * (pile.uniform() < 0.9 ? 1.04 : 0.64);  // 0.9 * 1.04 + 0.1 * 0.64 = 1
    PileFigures figures;
    figures.seed = i;
    figures.content_hash = luck.next_u64();
    figures.picks.total = figures.cleared.total = 10;
    for (int pick = 0; pick < 10; ++pick) figures.picks.hits += luck.uniform() < here ? 1 : 0;
    figures.cleared.hits = figures.picks.hits;
    figures.first_pick = "Succeeded";
    set.piles.push_back(figures);
  }
  return set;
}

Comparison gate(const PileSet& base, const PileSet& fresh, const GatePlan& plan, const GateRules& rules,
                bool intervals = true) {
  const std::vector<std::size_t> sizes = look_sizes(plan);
  for (std::size_t k = 0;; ++k) {
    Look look = look_at(plan, rules, k);
    look.intervals = intervals;
    look.resamples = 500;
    const Comparison comparison = compare_first(base, fresh, sizes[k], rules, look);
    if (is_certain(comparison, k + 1 == sizes.size())) return comparison;
  }
}

TEST(GatePlan, LooksEndAtTheLastSeed) {
  EXPECT_EQ(look_sizes({100, 30}), (std::vector<std::size_t>{30, 60, 90, 100}));
  EXPECT_EQ(look_sizes({60, 30}), (std::vector<std::size_t>{30, 60}));
  EXPECT_EQ(look_sizes({20, 30}), (std::vector<std::size_t>{20}));
}

// Nothing is spent twice and all of it can be: in proportion to the seeds.
TEST(GatePlan, SpendsTheBudgetsOnce) {
  const GatePlan plan{100, 30};
  const GateRules rules;
  double alpha = 0, doubt = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    alpha += look_at(plan, rules, k).alpha;
    doubt += 1 - look_at(plan, rules, k).confidence;
  }
  EXPECT_NEAR(alpha, rules.alpha, 1e-15);
  EXPECT_NEAR(doubt, 1 - rules.confidence, 1e-12);
  EXPECT_NEAR(look_at(plan, rules, 0).alpha, 0.3 * rules.alpha, 1e-15);
  EXPECT_NEAR(look_at(plan, rules, 3).alpha, 0.1 * rules.alpha, 1e-15);
}

// Equal bits: the smallest margin of a share is 2 points. Of n equal piles fewer than 2 % can differ as soon as
// 0.98^n <= 0.025 * 25 / 300, which is at n = 306: never in 300 seeds. With margins of 5 points n = 121, the look at
// 125.
TEST(GatePlan, EqualBitsAreCertainWhenTooFewPilesCanDiffer) {
  const PileSet set = simulated(1, "same", 0.9, 300);
  GateRules rules;
  EXPECT_EQ(gate(set, set, {300, 25}, rules).pairs, 300u);
  rules.recall.margin = rules.recall_first_look.margin = rules.precision.margin = 0.05;
  const Comparison early = gate(set, set, {300, 25}, rules);
  EXPECT_EQ(early.pairs, 125u);
  EXPECT_EQ(early.verdict, Verdict::kNoBitChanged);
  EXPECT_EQ(exit_code(early), 0);
}

TEST(GatePlan, CrashesEndIt) {
  const PileSet base = simulated(1, "same", 0.9, 100);
  PileSet fresh = base;
  fresh.piles[3].crashed = true;
  const Comparison crashed = gate(base, fresh, {100, 25}, {});
  EXPECT_EQ(crashed.pairs, 24u);
  EXPECT_EQ(exit_code(crashed), 5);
}

// 95 -> 85 %: found, and long before all seeds are used. 95 -> 95 %: never called worse in fifty gates of 1e-3.
TEST(GatePlan, FindsALossEarlyAndKeepsQuietWithoutOne) {
  const GatePlan plan{200, 25};
  double seeds = 0;
  for (std::uint64_t run = 0; run < 10; ++run) {
    const Comparison found = gate(simulated(run, "a", 0.95, 200), simulated(run, "b", 0.85, 200), plan, {});
    EXPECT_EQ(found.verdict, Verdict::kWorse) << "run " << run << ": " << sentence(found);
    seeds += static_cast<double>(found.pairs) / 10;
  }
  EXPECT_LT(seeds, 100);
  for (std::uint64_t run = 0; run < 50; ++run) {
    const Comparison equal = gate(simulated(run, "a", 0.95, 200), simulated(run, "b", 0.95, 200), plan, {}, false);
    EXPECT_NE(equal.verdict, Verdict::kWorse) << "run " << run << ": " << sentence(equal);
  }
}

// Equal versions at a level that fifty times ten looks can be held to: at most alpha of the gates, over all looks and
// metrics together.
TEST(GatePlan, FalseAlarmsStayWithinAlphaOverAllLooks) {
  constexpr int kRuns = 300;
  GateRules rules;
  rules.alpha = 0.1;
  int alarms = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const Comparison equal =
        gate(simulated(1000 + run, "a", 0.9, 100), simulated(1000 + run, "b", 0.9, 100), {100, 20}, rules, false);
    alarms += equal.verdict == Verdict::kWorse ? 1 : 0;
  }
  EXPECT_LE(alarms, 45);  // 30 at most expected, deviation 5.2
}

}  // namespace
}  // namespace binpick

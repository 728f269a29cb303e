#include "evaluation/error_budget.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/check.hpp"
#include "core/error.hpp"
#include "evaluation/paired_shares.hpp"
#include "evaluation/paired_tests.hpp"

namespace binpick {
namespace {

using Count = ClusterCount SweepPile::*;

Rate pooled(std::span<const SweepPile> piles, Count count, Seed seed) {
  std::vector<ClusterCount> counts;
  ClusterCount sum;
  for (const SweepPile& pile : piles) {
    counts.push_back(pile.*count);
    sum.hits += (pile.*count).hits;
    sum.total += (pile.*count).total;
  }
  Rate rate;
  rate.hits = static_cast<std::size_t>(std::llround(sum.hits));
  rate.total = static_cast<std::size_t>(std::llround(sum.total));
  rate.rate = sum.total > 0 ? sum.hits / sum.total : std::nan("");
  rate.interval = cluster_bootstrap(counts, seed);
  return rate;
}

std::vector<SharePair> pairs_of(std::span<const SweepPile> base, std::span<const SweepPile> fresh, Count count) {
  std::map<std::uint64_t, ClusterCount> by_seed;
  for (const SweepPile& pile : base) by_seed[pile.seed] = pile.*count;
  std::vector<SharePair> pairs;
  for (const SweepPile& pile : fresh)
    if (const auto found = by_seed.find(pile.seed); found != by_seed.end())
      pairs.push_back({found->second, pile.*count});
  return pairs;
}

/// Two-sided: the smaller of both tails, twice.
double sign_flip(std::span<const SharePair> pairs, Seed seed) {
  std::vector<double> losses = pile_losses(pairs);
  const double worse = sign_flip_worse(losses, seed.child("worse"));
  for (double& loss : losses) loss = -loss;
  return std::min(1.0, 2 * std::min(worse, sign_flip_worse(losses, seed.child("better"))));
}

BudgetGain gain_of(std::span<const SharePair> pairs, Seed seed) {
  SharePair sum;
  for (const SharePair& pair : pairs) sum += pair;
  const Interval loss = loss_interval(pairs, seed, 0.95);
  return {-sum.loss(), {-loss.high, -loss.low}, sign_flip(pairs, seed)};
}

void correct_for_rows(std::vector<BudgetRow>& rows, BudgetGain BudgetRow::*gain) {
  std::vector<double> p;
  for (std::size_t k = 1; k < rows.size(); ++k) p.push_back((rows[k].*gain).p);
  const std::vector<double> corrected = holm(p);
  for (std::size_t k = 1; k < rows.size(); ++k) (rows[k].*gain).p = corrected[k - 1];
}

}  // namespace

std::vector<BudgetRow> budget_rows(std::span<const BudgetRun> runs, Seed seed) {
  std::vector<BudgetRow> rows;
  for (const BudgetRun& run : runs) {
    const Seed own = seed.child(run.name);
    const std::vector<SweepPile>& piles = run.records.piles;
    BudgetRow row;
    row.name = run.name;
    row.error = run.error;
    row.piles = piles.size();
    row.cleared = pooled(piles, &SweepPile::cleared, own.child("cleared"));
    row.picks = pooled(piles, &SweepPile::picks, own.child("picks"));
    if (!rows.empty()) {
      const std::vector<SweepPile>& base = runs.front().records.piles;
      const std::vector<SharePair> cleared = pairs_of(base, piles, &SweepPile::cleared);
      if (cleared.empty()) throw SpecError(run.name + ": has no seed in common with " + runs.front().name);
      row.cleared_gain = gain_of(cleared, own.child("cleared gain"));
      row.picks_gain = gain_of(pairs_of(base, piles, &SweepPile::picks), own.child("picks gain"));
    }
    rows.push_back(row);
  }
  correct_for_rows(rows, &BudgetRow::cleared_gain);
  correct_for_rows(rows, &BudgetRow::picks_gain);
  return rows;
}

std::optional<double> bearable_error(std::span<const BudgetRow> curve) {
  if (curve.empty()) return std::nullopt;
  const double wanted = curve.front().picks.rate - kBearableLoss;
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const double before = curve[k - 1].picks.rate, after = curve[k].picks.rate;
    BP_CHECK(curve[k].error > curve[k - 1].error, "errors must rise");
    if (!(after < wanted)) continue;
    const double share = std::clamp((before - wanted) / (before - after), 0.0, 1.0);
    return curve[k - 1].error + share * (curve[k].error - curve[k - 1].error);
  }
  return std::nullopt;
}

}  // namespace binpick

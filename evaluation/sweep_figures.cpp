#include "evaluation/sweep_figures.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <map>

#include "core/check.hpp"
#include "evaluation/paired_shares.hpp"
#include "evaluation/paired_tests.hpp"
#include "evaluation/pile_figures.hpp"

namespace binpick {
namespace {

constexpr double kConfidence = 0.95;

using Counts = std::map<std::uint64_t, ClusterCount>;  // by seed

void add(ClusterCount& sum, const ClusterCount& other) {
  sum.hits += other.hits;
  sum.total += other.total;
}

// A resample of few seeds varies too little: Student's quantile and n - 1 in place of the normal one and n (Hesterberg
// 2015), as in cluster_bootstrap.
double widened(double confidence, std::size_t n) {
  if (n < kFewDifferingPiles) return confidence;  // exact bounds there
  const double count = static_cast<double>(n);
  const double t = boost::math::quantile(boost::math::students_t(count - 1), 0.5 + confidence / 2);
  return 2 * boost::math::cdf(boost::math::normal(), t * std::sqrt(count / (count - 1))) - 1;
}

struct Sweep {
  const SweepPlan& plan;
  std::span<const SweepRecords> records;
  int resamples;
  SignFlipEffort effort = {};
};

/// Cells taken together: a level, a field of a heat map, or one cell alone.
class Group {
 public:
  Group(const Sweep& sweep, std::vector<std::size_t> cells)
      : plan_(sweep.plan), records_(sweep.records), resamples_(sweep.resamples), cells_(std::move(cells)) {}

  const std::vector<std::size_t>& cells() const { return cells_; }

  Rate rate(ClusterCount SweepPile::*count, const std::string& name) const {
    Counts by_seed;
    for (const std::size_t cell : cells_)
      for (const SweepPile& pile : records_[cell].piles) add(by_seed[pile.seed], pile.*count);
    std::vector<ClusterCount> piles;
    ClusterCount sum;
    for (const auto& [seed, pile] : by_seed) {
      piles.push_back(pile);
      add(sum, pile);
    }
    Rate rate;
    rate.hits = static_cast<std::size_t>(std::llround(sum.hits));
    rate.total = static_cast<std::size_t>(std::llround(sum.total));
    rate.rate = pooled(count);
    rate.interval = cluster_bootstrap(piles, Seed{}.child("sweep").child(name), resamples_);
    return rate;
  }

  double pooled(ClusterCount SweepPile::*count) const {
    ClusterCount sum;
    for (const std::size_t cell : cells_)
      for (const SweepPile& pile : records_[cell].piles) add(sum, pile.*count);
    return sum.total > 0 ? sum.hits / sum.total : std::numeric_limits<double>::quiet_NaN();
  }

  double objective() const { return pooled(counted()); }

  std::size_t trials() const {
    std::size_t sum = 0;
    for (const std::size_t cell : cells_) sum += records_[cell].piles.size();
    return sum;
  }

  /// Per seed that every cell has, the mean over the cells: groups of different size then weigh the same.
  Counts complete() const {
    std::map<std::uint64_t, std::pair<std::size_t, ClusterCount>> by_seed;
    for (const std::size_t cell : cells_)
      for (const SweepPile& pile : records_[cell].piles) {
        auto& [seen, sum] = by_seed[pile.seed];
        ++seen;
        add(sum, pile.*counted());
      }
    Counts counts;
    const double size = static_cast<double>(cells_.size());
    for (const auto& [seed, entry] : by_seed)
      if (entry.first == cells_.size()) counts[seed] = {entry.second.hits / size, entry.second.total / size};
    return counts;
  }

 private:
  ClusterCount SweepPile::*counted() const {
    return plan_.objective == "picks" ? &SweepPile::picks : &SweepPile::cleared;
  }

  const SweepPlan& plan_;
  std::span<const SweepRecords> records_;
  int resamples_;
  std::vector<std::size_t> cells_;
};

/// Enough random sign patterns that one significant comparison of the family can show.
SignFlipEffort effort_for(std::size_t family, double alpha) {
  SignFlipEffort effort;
  const double needed = std::min(2e7, 4 * static_cast<double>(family) / alpha);
  effort.draws = std::max(effort.draws, static_cast<std::size_t>(needed));
  return effort;
}

std::optional<SweepDifference> difference(const Counts& best, const Counts& other, const std::string& name,
                                          const Sweep& sweep) {
  std::vector<SharePair> pairs;
  SharePair sum;
  for (const auto& [seed, count] : other) {
    const auto twin = best.find(seed);
    if (twin == best.end()) continue;
    pairs.push_back({twin->second, count});
    sum += pairs.back();
  }
  if (pairs.empty() || std::isnan(sum.loss())) return std::nullopt;
  const Seed stream = Seed{}.child("sweep_difference").child(name);
  SweepDifference d;
  d.seeds = pairs.size();
  d.value = -sum.loss();
  const Interval loss = loss_interval(pairs, stream, widened(kConfidence, pairs.size()), sweep.resamples);
  d.interval = {-loss.high, -loss.low};
  d.p = sign_flip_worse(pile_losses(pairs), stream, sweep.effort);
  return d;
}

/// The first of the largest rates; of equal ones that with more picks succeeded.
std::optional<std::size_t> best_of(const std::vector<Group>& groups) {
  std::optional<std::size_t> best;
  std::pair<double, double> highest;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const double objective = groups[k].objective();
    if (std::isnan(objective)) continue;
    const std::pair<double, double> here = {objective, groups[k].pooled(&SweepPile::picks)};
    if (best && here <= highest) continue;
    best = k;
    highest = here;
  }
  return best;
}

/// Differences from the best of these groups; p values as they are.
std::vector<std::optional<SweepDifference>> differences(const std::vector<Group>& groups, std::size_t best,
                                                        const std::string& name, const Sweep& sweep) {
  std::vector<std::optional<SweepDifference>> all(groups.size());
  const Counts base = groups[best].complete();
  for (std::size_t k = 0; k < groups.size(); ++k)
    if (k != best) all[k] = difference(base, groups[k].complete(), name + "/" + std::to_string(k), sweep);
  return all;
}

/// Holm over `family` comparisons, of which these are the ones that were looked at; the others count as not
/// significant.
void judge(std::vector<SweepDifference*> tested, std::size_t family, double alpha) {
  std::vector<double> p_values(std::max(family, tested.size()), 1.0);
  for (std::size_t k = 0; k < tested.size(); ++k) p_values[k] = tested[k]->p;
  const std::vector<double> adjusted = holm(p_values);
  for (std::size_t k = 0; k < tested.size(); ++k) {
    tested[k]->p_holm = adjusted[k];
    tested[k]->worse = adjusted[k] <= alpha && tested[k]->value < 0;
  }
}

std::vector<std::size_t> cells_with(const SweepPlan& plan, const std::map<std::size_t, std::size_t>& levels) {
  std::vector<std::size_t> cells;
  for (std::size_t c = 0; c < plan.cells.size(); ++c)
    if (std::all_of(levels.begin(), levels.end(),
                    [&](const auto& want) { return plan.cells[c].levels[want.first] == want.second; }))
      cells.push_back(c);
  return cells;
}

void fill_cells(Sweep sweep, SweepResult& result) {
  const std::span<const SweepRecords> records = sweep.records;
  std::vector<Group> groups;
  for (std::size_t c = 0; c < records.size(); ++c) {
    groups.emplace_back(sweep, std::vector<std::size_t>{c});
    SweepCell& cell = result.cells.emplace_back();
    cell.summary = records[c].summary;
    const std::size_t seeds = result.plan.end_seed - result.plan.first_seed;
    cell.missing = seeds - std::min(seeds, cell.summary.trials);
  }
  result.best = best_of(groups);
  if (!result.best) return;
  const std::size_t family = groups.size() * (groups.size() - 1);
  sweep.effort = effort_for(family, result.plan.alpha);
  const auto all = differences(groups, *result.best, "cell", sweep);
  std::vector<SweepDifference*> tested;
  for (std::size_t c = 0; c < all.size(); ++c) {
    result.cells[c].difference = all[c];
    if (all[c]) tested.push_back(&*result.cells[c].difference);
  }
  judge(tested, family, result.plan.alpha);
}

void fill_factors(Sweep sweep, SweepResult& result) {
  std::vector<SweepDifference*> tested;
  std::size_t family = 0;
  for (const SweepFactorPlan& factor : result.plan.factors) family += factor.levels.size() * (factor.levels.size() - 1);
  sweep.effort = effort_for(family, result.plan.alpha);
  result.factors.resize(result.plan.factors.size());
  for (std::size_t f = 0; f < result.factors.size(); ++f) {
    SweepFactor& factor = result.factors[f];
    const std::string name = result.plan.factors[f].name;
    const std::size_t count = result.plan.factors[f].levels.size();
    std::vector<Group> groups;
    for (std::size_t l = 0; l < count; ++l) groups.emplace_back(sweep, cells_with(result.plan, {{f, l}}));
    factor.best = best_of(groups);
    const auto all = factor.best ? differences(groups, *factor.best, name, sweep)
                                 : std::vector<std::optional<SweepDifference>>(count);
    for (std::size_t l = 0; l < count; ++l) {
      const std::string level = name + "/" + std::to_string(l);
      factor.levels.push_back({groups[l].cells().size(), groups[l].rate(&SweepPile::cleared, level),
                               groups[l].rate(&SweepPile::picks, level), all[l]});
    }
    for (SweepLevel& level : factor.levels)
      if (level.difference) tested.push_back(&*level.difference);
  }
  judge(tested, family, result.plan.alpha);
}

HeatMap heat_map(const Sweep& sweep, HeatMap map) {
  const SweepPlan& plan = sweep.plan;
  std::map<std::size_t, std::size_t> levels;
  if (map.given) levels.insert(*map.given);
  for (std::size_t r = 0; r < plan.factors[map.rows].levels.size(); ++r) {
    map.share.emplace_back();
    map.trials.emplace_back();
    for (std::size_t c = 0; c < plan.factors[map.columns].levels.size(); ++c) {
      levels[map.rows] = r;
      levels[map.columns] = c;
      const Group group(sweep, cells_with(plan, levels));
      map.share.back().push_back(group.objective());
      map.trials.back().push_back(group.trials());
    }
  }
  return map;
}

void fill_maps(const Sweep& sweep, SweepResult& result) {
  const SweepPlan& plan = result.plan;
  const std::size_t n = plan.factors.size();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b) {
      const auto add_map = [&](std::optional<std::pair<std::size_t, std::size_t>> given) {
        result.heat_maps.push_back(heat_map(sweep, {a, b, given, {}, {}}));
      };
      add_map(std::nullopt);
      if (n != 3) continue;
      const std::size_t third = 3 - a - b;
      for (std::size_t l = 0; l < plan.factors[third].levels.size(); ++l) add_map({{third, l}});
    }
}

}  // namespace

SweepRecords sweep_records(std::span<const TrialRecord> records) {
  SweepRecords out;
  out.summary = summarise(records, 0);
  for (const TrialRecord& record : records) {
    if (failure_of(record)) continue;
    out.piles.push_back({record.seed.key,
                         {static_cast<double>(record.placed), static_cast<double>(record.dropped)},
                         count_picks(record)});
  }
  return out;
}

SweepResult sweep_result(const SweepPlan& plan, std::span<const SweepRecords> records, int resamples) {
  BP_CHECK(records.size() == plan.cells.size(), records.size() << " of " << plan.cells.size() << " cells");
  SweepResult result;
  result.plan = plan;
  const Sweep sweep{result.plan, records, resamples};
  fill_cells(sweep, result);
  fill_factors(sweep, result);
  fill_maps(sweep, result);
  return result;
}

std::vector<std::size_t> not_worse(const SweepResult& result) {
  std::vector<std::size_t> cells;
  for (std::size_t c = 0; c < result.cells.size(); ++c)
    if (result.best == c || (result.cells[c].difference && !result.cells[c].difference->worse)) cells.push_back(c);
  return cells;
}

}  // namespace binpick

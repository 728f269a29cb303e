// How often intervals hold the truth.
#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "tools/bench/gate_bench.hpp"

namespace binpick {
namespace {

constexpr double kRates[] = {0.5, 0.8, 0.9, 0.95, 0.98, 0.99};
constexpr std::size_t kSizes[] = {10, 30, 50, 100, 300, 1000};

using BinomialInterval = Interval (*)(std::size_t, std::size_t, double);

double exact_coverage(BinomialInterval interval, double rate, std::size_t n) {
  double covered = 0;
  for (std::size_t hits = 0; hits <= n; ++hits) {
    const Interval i = interval(hits, n, 0.95);
    if (i.low <= rate && rate <= i.high)
      covered += binomial_at_least(hits, n, rate) - binomial_at_least(hits + 1, n, rate);
  }
  return covered;
}

void take(CoverageRow& row, double covered, const std::string& where, std::size_t points) {
  row.mean += covered / static_cast<double>(points);
  if (row.worst.empty() || covered < row.covered) row.covered = covered, row.worst = where;
}

std::vector<PileLaw> laws() {
  std::vector<PileLaw> all;
  for (const double rate : {0.80, 0.95})
    for (const double loss : {0.0, 0.05})
      for (const double spread : {0.08, 0.15}) {
        PileLaw& law = all.emplace_back();
        law.base_rate = rate;
        law.new_rate = rate - loss;
        law.spread = spread;
        law.errors = 0;
      }
  return all;
}

struct Covered {
  bool rate = false, loss = false;
};

// One experiment: `n` piles, the interval of the base's rate, and that of the loss against an equal version.
Covered experiment(const PileLaw& law, std::size_t n, Rng& rng, Seed seed) {
  std::vector<ClusterCount> counts;
  PileSet base, fresh;
  for (std::size_t i = 0; i < n; ++i) {
    const PilePair pair = draw_pair(law, i, rng);
    counts.push_back(pair.base.picks);
    base.piles.push_back(pair.base);
    fresh.piles.push_back(pair.fresh);
  }
  const Interval rate = cluster_bootstrap(counts, seed, 1000);
  Look look;
  look.confidence = 0.95;
  look.resamples = 1000;
  const Comparison comparison = compare(base, fresh, {}, look);
  const Interval loss = comparison.metrics.front().interval;  // picks
  const double truth = law.base_rate - law.new_rate;
  return {rate.low <= law.base_rate && law.base_rate <= rate.high, loss.low <= truth && truth <= loss.high};
}

}  // namespace

std::vector<CoverageRow> binomial_coverage() {
  CoverageRow exact{"Clopper-Pearson", "a rate of independent trials", 0, 0, ""}, wilson = exact;
  wilson.interval = "Wilson";
  const std::size_t points = std::size(kRates) * std::size(kSizes);
  for (const double rate : kRates)
    for (const std::size_t n : kSizes) {
      char where[60];
      std::snprintf(where, sizeof where, "rate %.2f, n %zu", rate, n);
      take(exact, exact_coverage(clopper_pearson, rate, n), where, points);
      take(wilson, exact_coverage(wilson_interval, rate, n), where, points);
    }
  return {exact, wilson};
}

std::vector<CoverageRow> pile_coverage(int runs, int threads) {
  std::vector<CoverageRow> rows;
  for (const std::size_t piles : {30, 100, 300}) {
    const std::string number = ", " + std::to_string(piles) + " piles";
    CoverageRow rate{"cluster bootstrap", "rate of picks" + number, 0, 0, ""};
    CoverageRow loss{"paired bootstrap", "loss of 0 or 5 points" + number, 0, 0, ""};
    for (const PileLaw& law : laws()) {
      char where[80];
      std::snprintf(where, sizeof where, "%.0f -> %.0f %%, spread %.2f", 100 * law.base_rate, 100 * law.new_rate,
                    law.spread);
      const Seed seed = Seed{}.child("bench/gate/coverage").child(where, piles);
      std::vector<Covered> covered(static_cast<std::size_t>(runs));
      parallel_for(covered.size(), threads, [&](std::size_t i) {
        Rng rng = seed.child("piles", i).rng();
        covered[i] = experiment(law, piles, rng, seed.child("bootstrap", i));
      });
      const auto share = [&](bool Covered::*member) {
        const auto hits = std::count_if(covered.begin(), covered.end(), [&](const Covered& c) { return c.*member; });
        return static_cast<double>(hits) / runs;
      };
      take(rate, share(&Covered::rate), where, laws().size());
      take(loss, share(&Covered::loss), where, laws().size());
    }
    rows.insert(rows.end(), {rate, loss});
  }
  return rows;
}

}  // namespace binpick

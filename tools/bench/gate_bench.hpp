// How good is the gate itself: how often it calls equal versions worse, how surely and after how many seeds it finds a
// real loss, and how often its intervals hold the truth.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "evaluation/gate_plan.hpp"
#include "tools/bench/gate_piles.hpp"

namespace binpick {

struct GateBenchConfig {
  GatePlan plan;
  GateRules rules;
  int runs = 1000;
  int threads = 1;
  int resamples = 1000;   ///< of the intervals at each look
  bool intervals = true;  ///< false: no gate ever passes early, so false alarms can only be more
};

struct GateRunCounts {
  std::string name;
  int runs = 0, worse = 0, held = 0, undecided = 0;
  double mean_seeds = 0;
  double mean_seeds_worse = 0;  ///< of those that ended in "worse"
  Interval worse_share;         ///< exact, 95 %
};

/// Pairs for one run of the gate, in the order of their seeds.
using DrawPairs = std::function<std::vector<PilePair>(std::size_t count, Rng& rng)>;

GateRunCounts run_gates(const std::string& name, const GateBenchConfig& config, const DrawPairs& draw);
DrawPairs pairs_of(const PileLaw& law);
/// Drawn with replacement from the pairs of two real runs. `swapped`: which of the two is the base is a coin per pile,
/// so that the versions are equal whatever they were.
DrawPairs pairs_of_runs(const PileSet& base, const PileSet& fresh, bool swapped);

struct CoverageRow {
  std::string interval, of;
  double covered = 0;  ///< share of the cases in which the truth lies inside; the smallest over the grid
  double mean = 0;     ///< over the grid
  std::string worst;   ///< where it is smallest
};

/// Clopper-Pearson and Wilson over a grid of rates and sample sizes, exactly (sums over the binomial law).
std::vector<CoverageRow> binomial_coverage();
/// Cluster bootstrap of a rate over simulated piles, and the paired interval of the loss; `runs` draws at each point.
std::vector<CoverageRow> pile_coverage(int runs, int threads);

}  // namespace binpick

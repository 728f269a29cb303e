// Two versions compared on the seeds they share (docs/gate.md). Bits first: where no hash differs nothing needs a test.
// Otherwise paired tests with the pile as the unit, Holm over the metrics, and non-inferiority against stated margins.
// A loss is always counted so that more of it is worse.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "evaluation/gate_rules.hpp"
#include "evaluation/paired_tests.hpp"
#include "evaluation/pile_figures.hpp"
#include "evaluation/stage_bits.hpp"

namespace binpick {

enum class Finding {
  kHolds,         ///< the loss is below the margin, as sure as the interval says
  kWorse,         ///< there is a loss (Holm), and it is not sure to be below the margin
  kUnclear,       ///< neither: more seeds are needed
  kNotEstimable,  ///< neither version has such a figure
};

enum class MetricKind { kShare, kVerdict, kQuantile };

struct MetricComparison {
  std::string name;   ///< key of the rules
  std::string label;  ///< for people
  Unit unit = Unit::kNone;
  MetricKind kind = MetricKind::kShare;
  MetricRule rule;
  double base = 0, fresh = 0;  ///< shares, or quantiles in SI; NaN: no such figure; infinite: too many misses
  double loss = 0;
  Interval interval;  ///< of the loss
  double p = 1;       ///< one-sided
  double p_holm = 1;
  std::size_t worse_piles = 0, better_piles = 0;
  Finding finding = Finding::kUnclear;
};

/// A pile whose verdict changed: picked empty or not, first pick succeeded or not.
struct Flip {
  std::uint64_t seed = 0;
  bool lost = true;
  std::string what;   ///< "first pick Succeeded -> NoSeal; cleared 10 of 10 -> 9 of 10"
  std::string stage;  ///< first stage that differs
};

enum class Verdict { kNoBitChanged, kHolds, kWorse, kInconclusive };

/// How much of the error budgets one look may spend. A comparison of finished runs spends all of it at once.
struct Look {
  double alpha = 1e-3;
  double confidence = 0.95;
  bool intervals = true;  ///< false: tests only, nothing can hold (for simulations of false alarms)
  int resamples = 4000;
};

struct Comparison {
  PileSet base, fresh;  ///< without their piles
  GateRules rules;
  Look look;                                         ///< the budgets that findings and intervals were judged by
  std::size_t pairs = 0;                             ///< seeds that were compared
  std::size_t only_base = 0, only_fresh = 0;         ///< seeds without a partner
  std::vector<std::uint64_t> base_crashes, crashes;  ///< seeds left out of the tests
  std::vector<BitDifference> differences;            ///< ascending seeds
  std::map<std::string, std::size_t> differing_stages;
  Interval changed_share;       ///< of all piles, exact; the upper end is what a change can have touched
  std::size_t equal_heaps = 0;  ///< pairs that were the same pile before the first look
  std::vector<MetricComparison> metrics;
  std::vector<Flip> flips;  ///< losses first
  Verdict verdict = Verdict::kInconclusive;
  bool too_many_crashes = false;
};

/// Throws SpecError when no seed is in both.
Comparison compare(const PileSet& base, const PileSet& fresh, const GateRules& rules, const Look& look);
Comparison compare(const PileSet& base, const PileSet& fresh, const GateRules& rules);

/// One sentence. Exit code of ARCHITECTURE section 14: 0 pass, 1 regression, 3 inconclusive, 5 too many crashes.
std::string sentence(const Comparison& comparison);
int exit_code(const Comparison& comparison);

/// "binpick trial RUN/scenario.yaml --seed N", quoted for a shell.
std::string replay_command(const Comparison& comparison, std::uint64_t seed);

std::string comparison_text(const Comparison& comparison);
std::string comparison_markdown(const Comparison& comparison);
std::string comparison_json(const Comparison& comparison);
std::string comparison_junit(const Comparison& comparison);

/// Private to this folder: the metrics of the pairs, Holm and findings included.
std::vector<MetricComparison> compare_metrics(const std::vector<const PileFigures*>& base,
                                              const std::vector<const PileFigures*>& fresh, const GateRules& rules,
                                              const Look& look);

}  // namespace binpick

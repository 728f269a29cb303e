// The error budget of a scene: the same seeds with one stage after the other replaced by its oracle, and how much each
// of them costs; and how large an error of the pose this part with this tool bears. Differences are paired by seed, the
// unit is the pile (paired_shares.hpp). docs/budget.md.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/summary.hpp"
#include "evaluation/sweep_figures.hpp"

namespace binpick {

/// One campaign of the budget.
struct BudgetRun {
  std::string name;  ///< of the stage that is told the truth; first: the scene as it is
  double error = 0;  ///< of an error curve: standard deviation per axis, m or rad; first: none
  SweepRecords records;
};

/// A share less that of the first run, on the seeds that both have.
struct BudgetGain {
  double value = 0;
  Interval interval;  ///< 95 %
  double p = 1;       ///< two-sided sign-flip test, Holm over the table's rows
};

struct BudgetRow {
  std::string name;
  double error = 0;
  Rate cleared, picks;
  BudgetGain cleared_gain, picks_gain;  ///< zero in the first row
  std::size_t piles = 0;
};

struct ErrorBudget {
  std::string scene;
  std::uint64_t first_seed = 0, end_seed = 0;
  std::vector<BudgetRow> stages, translation, rotation;
  std::vector<std::string> absent;  ///< stages that are perfect in the scene already
};

/// Empty runs give an empty table. Throws SpecError when no seed is common to all runs of a table.
std::vector<BudgetRow> budget_rows(std::span<const BudgetRun> runs, Seed seed);

/// By how much the share of successful picks may fall before an error counts as too large.
inline constexpr double kBearableLoss = 0.05;
/// The error (m or rad) at which it has fallen so far, read off between the curve's points; none: nowhere on it.
std::optional<double> bearable_error(std::span<const BudgetRow> curve);

std::string budget_text(const ErrorBudget& budget);
std::string budget_markdown(const ErrorBudget& budget);
std::string budget_csv(const ErrorBudget& budget);
/// SI units; null: not known.
std::string budget_json(const ErrorBudget& budget);

}  // namespace binpick

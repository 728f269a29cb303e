// What a sweep found (docs/sweeps.md): every cell's figures, every factor's levels side by side, and which cells are
// not worse than the best. Cells share their seeds, so they are compared seed by seed: the unit is the seed, whose pile
// is the same in all cells that drop the same parts.
//
// Whoever compares with the best of many compares with a cell that was lucky as well as good. Each test against it is
// therefore one of all K (K - 1) comparisons that might have been made (Holm over the lot, the others taken as not
// significant), and the chance that anything at all is wrongly called worse stays below alpha.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/report.hpp"
#include "evaluation/summary.hpp"
#include "evaluation/sweep_plan.hpp"

namespace binpick {

/// One measured trial.
struct SweepPile {
  std::uint64_t seed = 0;
  ClusterCount cleared, picks;
};

/// The records of one cell. Failed trials are in the summary and in no pile.
struct SweepRecords {
  CampaignSummary summary;
  std::vector<SweepPile> piles;  ///< ascending seeds
};
SweepRecords sweep_records(std::span<const TrialRecord> records);

/// In the objective, against the best: negative is worse.
struct SweepDifference {
  double value = 0;
  Interval interval;  ///< 95 % for itself
  double p = 1;       ///< one-sided: as bad as this by luck
  double p_holm = 1;
  std::size_t seeds = 0;  ///< that both have
  bool worse = false;     ///< p_holm <= alpha
};

struct SweepLevel {
  std::size_t cells = 0;
  Rate cleared, picks;
  std::optional<SweepDifference> difference;  ///< none: the best, or no seed in common with it
};

struct SweepFactor {
  std::vector<SweepLevel> levels;
  std::optional<std::size_t> best;
};

struct SweepCell {
  CampaignSummary summary;
  std::size_t missing = 0;  ///< seeds without a record
  std::optional<SweepDifference> difference;
};

/// The objective of two factors' levels, over all other factors or at one level of a third.
struct HeatMap {
  std::size_t rows = 0, columns = 0;                         ///< factors
  std::optional<std::pair<std::size_t, std::size_t>> given;  ///< factor and level
  std::vector<std::vector<double>> share;                    ///< NaN: nothing was run there
  std::vector<std::vector<std::size_t>> trials;
};

struct SweepResult {
  SweepPlan plan;
  std::vector<SweepCell> cells;
  std::optional<std::size_t> best;  ///< cell; none: nothing was run
  std::vector<SweepFactor> factors;
  std::vector<HeatMap> heat_maps;  ///< every pair of factors; of three factors also by level of the third
};

/// `records` are of the plan's cells in their order; none yet: an empty one.
SweepResult sweep_result(const SweepPlan& plan, std::span<const SweepRecords> records, int resamples = 4000);

/// Cells that the data cannot tell from the best, the best included.
std::vector<std::size_t> not_worse(const SweepResult& result);

/// The cells, before anything is run.
std::string sweep_plan_text(const SweepPlan& plan);
std::string sweep_text(const SweepResult& result);
std::string sweep_markdown(const SweepResult& result);
/// One self-contained page; what stands beside it: the cells' folders, to which it links.
std::string html_sweep(const SweepResult& result, const std::vector<PageSources::Picture>& heat_maps);
std::string sweep_cells_csv(const SweepResult& result);
std::string sweep_factors_csv(const SweepResult& result);
/// SI and radians; null: not known. `pictures`: file of each heat map, or none at all.
std::string sweep_json(const SweepResult& result, std::span<const std::string> pictures = {});

}  // namespace binpick

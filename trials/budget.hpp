// `binpick budget`: a scene as it is, then with one stage after the other replaced by its oracle, then with all of
// them, on the same seeds; and the scene's picks with true poses that are disturbed by stated errors. Both are sweeps
// (sweep.hpp), kept in OUT/stages and OUT/errors, so that they resume, merge and replay as sweeps do.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "evaluation/error_budget.hpp"
#include "trials/sweep_run.hpp"

namespace binpick {

struct BudgetPlan {
  std::string scene;  ///< file
  std::uint64_t first_seed = 0, end_seed = 0;
  bool stages = true;
  std::vector<double> translation;  ///< m, standard deviation per axis; rising
  std::vector<double> rotation;     ///< rad, the same
};

/// The sweep files, as YAML; paths in them are absolute. Empty text: nothing to run. Throws SpecError: several cameras.
struct BudgetFiles {
  std::string stages, errors;
  std::vector<std::string> absent;  ///< stages that are perfect in the scene already
};
BudgetFiles budget_files(const BudgetPlan& plan);

struct BudgetRunResult {
  ErrorBudget budget;
  SweepRun run;
};
/// `options`: of every cell's campaign; its `out` is the budget's folder.
BudgetRunResult run_budget(const BudgetPlan& plan, const CampaignOptions& options, const std::string& program,
                           ProgressSink& progress);

}  // namespace binpick

// The gate: a scene is run on the seeds of a baseline file, a block at a time, and compared after each block; it stops
// as soon as the verdict is certain (evaluation/gate_plan.hpp, docs/gate.md). Trials run in a campaign's workers.
#pragma once

#include <string>

#include "core/progress.hpp"
#include "evaluation/gate_plan.hpp"
#include "trials/campaign.hpp"

namespace binpick {

struct GateOptions {
  std::string baseline;      ///< file
  CampaignOptions campaign;  ///< scene, fresh run folder, workers; its seeds are set here
  GatePlan plan;             ///< max_seeds is cut to the baseline's
  GateRules rules;
};

struct GateResult {
  Comparison comparison;
  std::size_t seeds = 0, max_seeds = 0, looks = 0;
  bool interrupted = false;
  int worker_exit = 0;  ///< as in CampaignResult: then there is no comparison
};

/// Throws SpecError: a baseline with gaps between its seeds, a run folder that holds records (of which build?).
GateResult run_gate(const GateOptions& options, const std::string& program, ProgressSink& progress);

}  // namespace binpick

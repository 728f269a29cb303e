// A sweep run: every cell is a campaign in a run folder of its own, `DIR/cells/..`, with the scene written out in full,
// so that whatever works on a run works on a cell. The same command completes a sweep that was stopped.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "evaluation/sweep_figures.hpp"
#include "trials/campaign.hpp"
#include "trials/sweep.hpp"

namespace binpick {

struct SweepRun {
  std::size_t failed = 0;    ///< trials that are no measurement
  bool interrupted = false;  ///< as in CampaignResult
  int worker_exit = 0;
};

/// `options` are those of each cell's campaign; its `out` is the sweep's folder, scene and seeds are set here. Of N
/// shards one takes a cell's seeds by their hash, another one for each cell: few seeds are spread over many machines.
/// Throws SpecError before anything is run when any cell's scene cannot be meant.
SweepRun run_sweep(const SweepSetup& sweep, const CampaignOptions& options, const std::string& program,
                   ProgressSink& progress);

/// The shard of `cell` that shard `shard` of the sweep runs.
int cell_shard(const std::string& cell_folder, int shard, int shards);

bool is_sweep_folder(const std::string& folder);
/// Of the records that are there. Throws SpecError, AssetError.
SweepResult read_sweep_result(const std::string& folder);

struct SweepMerge {
  std::vector<std::string> conflicts;  ///< "cells/x seed 5003": not empty, and nothing was written
  std::size_t missing = 0;             ///< trials of the plan without a record
  std::string first_missing;           ///< "cells/x seed 5003"
};

/// The folders of a sweep's shards as one, cell by cell (run_merge.hpp). Throws SpecError: sweeps of different plans.
SweepMerge merge_sweeps(std::span<const std::string> folders, const std::string& out);

}  // namespace binpick

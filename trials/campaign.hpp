// A campaign: one scenario, many seeds, worker processes. The coordinator calls no physics and no GL, so nothing that
// happens inside a trial can take it down. A trial over which a worker dies, hangs or fills its memory is repeated once
// in a fresh worker; then it is recorded as what it was, a failed trial, never as a failed pick. The run folder is that
// of ARCHITECTURE section 14; a folder that already holds records of the same scenario and build is completed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "evaluation/summary.hpp"
#include "trials/campaign_worker.hpp"
#include "trials/scenario.hpp"

namespace binpick {

struct CampaignOptions {
  std::string scene;
  std::string out;
  ScenarioOverrides overrides;
  std::uint64_t first_seed = 0, end_seed = 0;  ///< [first, end)
  int shard = 1, shards = 1;                   ///< of these seeds: shard `shard` (1 ..) of so many (run_merge.hpp)
  int workers = 1;
  WorkerLimits limits;
  std::uint64_t shuffle = 0;  ///< 0: seeds in their order; else in one drawn from this
  std::string plant;          ///< faults planted on purpose (planted_fault.hpp); empty: none
  int pictured = 1;           ///< looks pictured per trial; failed picks always are; negative: no pictures at all
};

struct CampaignResult {
  CampaignSummary summary;
  double wall = 0;           ///< s, of this run of the campaign
  double trial_wall = 0;     ///< s, of the trials recorded in it, summed
  bool interrupted = false;  ///< SIGINT or SIGTERM: what was in flight was finished
  int worker_exit = 0;       ///< 2: the scene could not be loaded; 5: no worker came up; 6: storage
};

/// `program` is this executable, re-run as `program worker ..`.
CampaignResult run_campaign(const CampaignOptions& options, const std::string& program, ProgressSink& progress);

/// Writes summary.json, report.html, picks.csv and results.md from the records of a run folder.
CampaignSummary write_reports(const std::string& run_folder, double wall_seconds);

}  // namespace binpick

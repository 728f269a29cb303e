// The reports of a run folder, from its records, pictures and replays: summary.json, results.md, picks.csv, tables/ and
// report.html.
#pragma once

#include <string>

#include "core/progress.hpp"
#include "evaluation/summary.hpp"
#include "trials/replay.hpp"

namespace binpick {

struct ReportOptions {
  std::size_t replays = 20;         ///< at most so many in the page, trials with failed picks first
  std::size_t largest = 9'500'000;  ///< bytes of all replays and the page around them
  bool run_again = false;           ///< trials without a kept replay are run again for it
};

/// `wall_seconds`: of the campaign; <= 0: unknown. Throws SpecError, AssetError, StorageError.
CampaignSummary write_reports(const std::string& run_folder, double wall_seconds, const ReportOptions& options,
                              ProgressSink* progress = nullptr);

/// The trial of a record, run again in the run folder's scenario. Throws SpecError: no such record, or it does not come
/// out as recorded.
Replay replay_again(const std::string& run_folder, std::uint64_t seed);

/// One trial's replay as a page of its own, from the kept one, or run again where there is none.
void write_replay_page(const std::string& run_folder, std::uint64_t seed, const std::string& path);

}  // namespace binpick

// Runs of parts of a campaign, put together: a campaign spread over machines with --shard, or over several evenings.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evaluation/summary.hpp"

namespace binpick {

/// The seeds of shard `index` (1 .. count): chosen by the seed's hash, so that slow seeds, which often lie together,
/// are spread. Every seed belongs to exactly one shard of `count`.
bool in_shard(std::uint64_t seed, int index, int count);

struct MergedRecords {
  std::vector<TrialRecord> records;      ///< by seed
  std::vector<std::uint64_t> conflicts;  ///< seeds that came with different results
};

/// Set union by seed, whatever the order of the runs. A record beats a failed trial of the same seed; two with the same
/// hash are one (the one whose line comes first in the alphabet, so that wall times do not depend on the order either).
/// Throws SpecError: records of different scenarios or builds.
MergedRecords merge_records(std::span<const std::vector<TrialRecord>> runs);

struct MergeResult {
  CampaignSummary summary;
  std::vector<std::uint64_t> conflicts;  ///< not empty: nothing was written
  std::vector<std::uint64_t> missing;    ///< of the seeds that were asked for
};

/// Writes a run folder of its own: records, scenario, reports. `first_seed` .. `end_seed`: what should be there; equal:
/// no matter. Throws SpecError, StorageError.
MergeResult merge_runs(std::span<const std::string> runs, const std::string& out, std::uint64_t first_seed,
                       std::uint64_t end_seed);

}  // namespace binpick

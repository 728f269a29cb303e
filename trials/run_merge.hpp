// Runs of parts of a campaign, put together: a campaign spread over machines with --shard, or over several evenings.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "evaluation/record_lines.hpp"
#include "evaluation/summary.hpp"

namespace binpick {

/// The seeds of shard `index` (1 .. count): chosen by the seed's hash, so that slow seeds, which often lie together,
/// are spread. Every seed belongs to exactly one shard of `count`.
bool in_shard(std::uint64_t seed, int index, int count);

/// Which record of each seed is kept: a set union by seed, whatever the order in which they come. A record beats a
/// failed trial of the same seed; two with the same hash are one (the one whose line comes first in the alphabet, so
/// that wall times do not depend on the order either). Lines stay where they are: a hundred thousand seeds take a few
/// megabytes.
class MergeIndex {
 public:
  /// Throws SpecError: of another scenario or build than the first one.
  void add(const TrialRecord& record, const RecordLine& line);

  struct Kept {
    std::uint64_t hash = 0;
    bool failed = false;
    std::string file;
    std::uint64_t offset = 0;
    std::size_t bytes = 0;
  };
  const std::map<std::uint64_t, Kept>& seeds() const { return seeds_; }
  /// Seeds that came with different results, ascending.
  const std::set<std::uint64_t>& conflicts() const { return conflicts_; }

 private:
  std::map<std::uint64_t, Kept> seeds_;
  std::set<std::uint64_t> conflicts_;
  std::string scenario_hash_, build_;
  std::uint64_t first_ = 0;
};

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

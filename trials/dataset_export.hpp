// A campaign as a data set in BOP's format, and its estimates as BOP's results file (docs/bop.md). What the records do
// not hold is made again from their seeds: the heap, the first look at it, the estimates. Each trial is a scene, its
// seed the scene's number, the first look of the (first) camera its image 0; part k of the scenario is object k + 1.
// Objects are drawn about the centre O of their bounding box, as the format wants it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "evaluation/bop_results.hpp"

namespace binpick {

struct ReplayedRun {
  std::vector<std::uint64_t> seeds;      ///< that became scenes
  std::vector<std::uint64_t> skipped;    ///< no measurement, or the heap was not at rest in the bin
  std::vector<std::uint64_t> different;  ///< the frame (or the estimates' scores) is not the one of the record
  bool same_build = true;                ///< the records are of this very program
};

/// Renders and writes the data set; at most `most` scenes, by seed. Throws SpecError: no run folder, records of another
/// scenario than its scenario.yaml, `out` not empty, a seed that is no scene number; StorageError.
ReplayedRun export_dataset(const std::string& run_folder, const std::string& out, std::size_t most,
                           ProgressSink& progress);

/// Estimates anew from the same first looks. Times are those of this computation.
ReplayedRun estimates_of_run(const std::string& run_folder, std::size_t most, ProgressSink& progress,
                             std::vector<BopEstimate>& estimates);

}  // namespace binpick

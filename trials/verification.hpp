// Do the records of a run come out again? A sample of its trials is run anew, from the run folder's own scenario, and
// compared stage by stage.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "evaluation/stage_bits.hpp"

namespace binpick {

struct Verification {
  std::vector<std::uint64_t> seeds;        ///< that were run again
  std::vector<BitDifference> differences;  ///< the first stage that differs, of every one that does
  bool same_build = true;                  ///< the records are of this very program
};

/// `sample` trials, chosen by the hash of their seeds; all where there are no more. Failed trials are left out. Throws
/// SpecError: no run folder, records of another scenario than its scenario.yaml.
Verification verify_run(const std::string& run_folder, std::size_t sample, ProgressSink& progress);

}  // namespace binpick

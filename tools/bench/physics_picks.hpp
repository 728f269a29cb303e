// What one executed pick costs: the first picks of many full bins, planned on the truth (oracle), so that every pick
// that is planned is executed. Dropping, looking and planning are outside the clock.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/pick_outcome.hpp"
#include "core/random.hpp"

namespace binpick {

struct PicksBenchConfig {
  std::string scene = "scenes/bearing_bin_30.yaml";
  std::uint64_t first_seed = 100, last_seed = 103;
  int picks = 4;           ///< of every heap, fewer when nothing more can be planned
  bool freeze_far = true;  ///< physics.freeze_far
};

struct PickCost {
  std::uint64_t seed = 0;
  int pick = 0;
  std::string outcome, reason;
  double simulated = 0;  ///< s
  double cpu = 0;        ///< s of one core
  int left_in_bin = 0;   ///< parts before the pick
  int neighbours_moved = 0;
  double peak_force = 0, swing = 0;
};

std::vector<PickCost> bench_picks(const PicksBenchConfig& config);

}  // namespace binpick

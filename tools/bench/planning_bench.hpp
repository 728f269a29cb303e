// What planning one pick costs: every look of some trials whose estimates are the truth, the picks executed in between,
// so that the heap empties as it does in use. Looks that end without a plan count too: they are the dearest.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace binpick {

struct PlanningBenchConfig {
  std::string scene;
  std::uint64_t first_seed = 0, last_seed = 3;
  int picks = 5;  ///< looks of every heap
};

struct PlanningCost {
  std::uint64_t seed = 0;
  int pick = 0;
  double cpu = 0;  ///< s of one core
  bool planned = false;
  std::size_t estimates = 0, rejected = 0;  ///< candidates tried and given up
  std::string reason;                       ///< when nothing was planned
  std::string outcome;                      ///< of the executed pick
  std::string ended;                        ///< what ended it early, as its record says
  /// Of the planned pick: the tool off the vertical (rad) at contact, at release, and at most in between.
  double tilt_pick = 0, tilt_place = 0, tilt_carry = 0;
  /// s, of the plan's four motions; of the whole execution, and of its vacuum (contact, build-up, venting).
  double approach = 0, lift = 0, place = 0, back = 0, executed = 0, vacuum = 0;
};

std::vector<PlanningCost> bench_planning(const PlanningBenchConfig& config);

}  // namespace binpick

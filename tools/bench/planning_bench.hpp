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
};

std::vector<PlanningCost> bench_planning(const PlanningBenchConfig& config);

}  // namespace binpick

// The loop of the benches that pick: a heap emptied by picks that are planned on the truth (oracle).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "trials/observation.hpp"
#include "trials/scenario.hpp"

namespace binpick {

/// One look at the heap and what was planned on it.
struct TruthPick {
  CellWorld& cell_world;
  const PlanResult& plan;
  int pick = 0;
  std::size_t estimates = 0;
  double planning_cpu = 0;  ///< s of this thread
};

/// The scene with the truth in place of its estimator and an ideal sensor. Throws as read_scenario.
Scenario truth_scenario(const std::string& scene);

/// Drops the seed's heap and picks at most `picks` parts. `execute` is called for every look with a part in sight and
/// carries out the plan, if there is one; without one the heap is given up: it would be refused again.
void pick_on_truth(const Scenario& scenario, TrialContext& context, std::uint64_t seed, int picks,
                   const std::function<PickOutcome(const TruthPick&)>& execute);

}  // namespace binpick

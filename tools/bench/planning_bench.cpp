#include "tools/bench/planning_bench.hpp"

#include <algorithm>

#include "robot/tool_tilt.hpp"
#include "tools/bench/truth_picks.hpp"

namespace binpick {
namespace {

void note_motion(const Cell& cell, const PickPlan& plan, PlanningCost& cost) {
  cost.tilt_pick = tool_tilt(cell, plan.lift.q.front());
  cost.tilt_place = tool_tilt(cell, plan.place.q.back());
  cost.tilt_carry = std::max(largest_tilt(cell, plan.lift), largest_tilt(cell, plan.place));
  cost.approach = plan.approach.duration();
  cost.lift = plan.lift.duration();
  cost.place = plan.place.duration();
  cost.back = plan.back.duration();
}

}  // namespace

std::vector<PlanningCost> bench_planning(const PlanningBenchConfig& config) {
  Scenario scenario = truth_scenario(config.scene);
  TrialContext context = make_trial_context(scenario);
  std::vector<PlanningCost> costs;
  for (std::uint64_t seed = config.first_seed; seed < config.last_seed; ++seed)
    pick_on_truth(scenario, context, seed, config.picks, [&](const TruthPick& look) {
      PlanningCost& cost = costs.emplace_back();
      cost.cpu = look.planning_cpu;
      cost.seed = seed;
      cost.pick = look.pick;
      cost.planned = look.plan.plan.has_value();
      cost.estimates = look.estimates;
      cost.rejected = look.plan.rejected.size();
      cost.reason = look.plan.reason;
      if (!cost.planned) return look.plan.outcome;
      note_motion(scenario.cell, *look.plan.plan, cost);
      const ExecutionResult result = execute_pick(look.cell_world, *look.plan.plan, scenario.execution);
      cost.outcome = to_string(result.outcome);
      cost.ended = result.reason;
      cost.executed = result.motion_time;
      cost.vacuum = result.vacuum_time;
      return result.outcome;
    });
  return costs;
}

}  // namespace binpick

#include "tools/bench/physics_picks.hpp"

#include "tools/bench/cpu_clock.hpp"
#include "trials/observation.hpp"
#include "trials/oracle.hpp"

namespace binpick {
namespace {

int count_in(const CellWorld& cell_world, bool (CellWorld::*where)(std::size_t) const) {
  int count = 0;
  for (std::size_t i = 0; i < cell_world.heap().bodies.size(); ++i) count += (cell_world.*where)(i) ? 1 : 0;
  return count;
}

PickCost cost_of(CellWorld& cell_world, const PickPlan& plan, const ExecutionConfig& config) {
  PickCost cost;
  cost.left_in_bin = count_in(cell_world, &CellWorld::in_bin);
  const CpuClock clock;
  const ExecutionResult result = execute_pick(cell_world, plan, config);
  cost.cpu = clock.seconds();
  cost.outcome = to_string(result.outcome);
  cost.reason = result.reason;
  cost.simulated = result.motion_time + result.vacuum_time;
  cost.neighbours_moved = result.neighbours_moved;
  cost.peak_force = result.peak_force;
  cost.swing = result.swing;
  return cost;
}

void pick_from_heap(const Scenario& s, TrialContext& context, std::uint64_t number, int picks,
                    std::vector<PickCost>& costs) {
  const Seed seed{number};
  CellWorld cell_world(s.cell, s.physics, context.parts);
  drop_heap(s, context, seed, cell_world);
  std::vector<Eigen::Vector3d> failed_W;
  for (int pick = 0; pick < picks; ++pick) {
    const Observation seen = observe(s, cell_world, context, seed, pick);
    const EstimateResult found = oracle_estimate(seen.truth, context.parts, s.oracle, seed.child("estimator"));
    const PlanResult plan = context.planner->plan(found, seen.view, seen.X_WC_believed,
                                                  count_in(cell_world, &CellWorld::in_tray), failed_W);
    if (!plan.plan) return;
    costs.push_back(cost_of(cell_world, *plan.plan, s.execution));
    costs.back().seed = number;
    costs.back().pick = pick;
    const Part& part = context.parts[found.estimates[plan.plan->estimate].part];
    if (costs.back().outcome != to_string(PickOutcome::kSucceeded))
      failed_W.push_back(plan.plan->X_WP_est * part.box_center_P);
    else
      failed_W.clear();
  }
}

}  // namespace

std::vector<PickCost> bench_picks(const PicksBenchConfig& config) {
  Scenario scenario = read_scenario(config.scene, {"ideal"});
  scenario.estimator.reset();  // the truth is planned on
  scenario.estimator_type = "oracle";
  scenario.physics.freeze_far = config.freeze_far;
  TrialContext context = make_trial_context(scenario);
  std::vector<PickCost> costs;
  for (std::uint64_t seed = config.first_seed; seed < config.last_seed; ++seed)
    pick_from_heap(scenario, context, seed, config.picks, costs);
  return costs;
}

}  // namespace binpick

#include "tools/bench/planning_bench.hpp"

#include "tools/bench/cpu_clock.hpp"
#include "trials/observation.hpp"
#include "trials/oracle.hpp"

namespace binpick {
namespace {

int parts_in_tray(const CellWorld& cell_world) {
  int count = 0;
  for (std::size_t i = 0; i < cell_world.heap().bodies.size(); ++i) count += cell_world.in_tray(i) ? 1 : 0;
  return count;
}

void plan_heap(const Scenario& s, TrialContext& context, std::uint64_t number, int picks,
               std::vector<PlanningCost>& costs) {
  const Seed seed{number};
  CellWorld cell_world(s.cell, s.physics, context.parts);
  drop_heap(s, context, seed, cell_world);
  std::vector<Eigen::Vector3d> failed_W;
  for (int pick = 0; pick < picks; ++pick) {
    const Observation seen = observe(s, cell_world, context, seed, pick);
    const EstimateResult found = oracle_estimate(seen.truth, context.parts, s.oracle, seed.child("estimator"));
    if (found.estimates.empty()) return;
    const double before = thread_cpu_seconds();
    const PlanResult plan =
        context.planner->plan(found, seen.view, seen.X_WC_believed, parts_in_tray(cell_world), failed_W);
    PlanningCost cost;
    cost.cpu = thread_cpu_seconds() - before;
    cost.seed = number;
    cost.pick = pick;
    cost.planned = plan.plan.has_value();
    cost.estimates = found.estimates.size();
    cost.rejected = plan.rejected.size();
    cost.reason = plan.reason;
    costs.push_back(cost);
    if (!plan.plan) return;  // the same heap would be refused again
    const ExecutionResult result = execute_pick(cell_world, *plan.plan, s.execution);
    costs.back().outcome = to_string(result.outcome);
    const Part& part = context.parts[found.estimates[plan.plan->estimate].part];
    if (result.outcome == PickOutcome::kSucceeded)
      failed_W.clear();
    else
      failed_W.push_back(plan.plan->X_WP_est * part.box_center_P);
  }
}

}  // namespace

std::vector<PlanningCost> bench_planning(const PlanningBenchConfig& config) {
  Scenario scenario = read_scenario(config.scene, {"ideal"});
  scenario.estimator.reset();  // the truth is planned on
  scenario.estimator_type = "oracle";
  TrialContext context = make_trial_context(scenario);
  std::vector<PlanningCost> costs;
  for (std::uint64_t seed = config.first_seed; seed < config.last_seed; ++seed)
    plan_heap(scenario, context, seed, config.picks, costs);
  return costs;
}

}  // namespace binpick

#include "tools/bench/truth_picks.hpp"

#include "tools/bench/cpu_clock.hpp"
#include "trials/oracle.hpp"

namespace binpick {
namespace {

int parts_in_tray(const CellWorld& cell_world) {
  int count = 0;
  for (std::size_t i = 0; i < cell_world.heap().bodies.size(); ++i) count += cell_world.in_tray(i) ? 1 : 0;
  return count;
}

}  // namespace

Scenario truth_scenario(const std::string& scene) {
  Scenario scenario = read_scenario(scene, {"ideal"});
  scenario.estimator.reset();
  scenario.estimator_type = "oracle";
  return scenario;
}

void pick_on_truth(const Scenario& s, TrialContext& context, std::uint64_t number, int picks,
                   const std::function<PickOutcome(const TruthPick&)>& execute) {
  const Seed seed{number};
  CellWorld cell_world(s.cell, s.physics, context.parts);
  drop_heap(s, context, seed, cell_world);
  std::vector<Eigen::Vector3d> failed_W;
  std::vector<PlacedPart> in_tray;
  for (int pick = 0; pick < picks; ++pick) {
    const Observation seen = observe(s, cell_world, context, seed, pick);
    const EstimateResult found = oracle_estimate(seen.truth, context.parts, s.oracle, seed.child("estimator"));
    if (found.estimates.empty()) return;
    const double before = thread_cpu_seconds();
    const PlanResult plan =
        context.planner->plan(found, seen.view, seen.X_WC_believed, {parts_in_tray(cell_world), failed_W, {}, in_tray});
    const double cpu = thread_cpu_seconds() - before;
    const PickOutcome outcome = execute({cell_world, plan, pick, found.estimates.size(), cpu});
    if (!plan.plan) return;
    const Part& part = context.parts[found.estimates[plan.plan->estimate].part];
    if (outcome == PickOutcome::kSucceeded) {
      in_tray.push_back({found.estimates[plan.plan->estimate].part, plan.plan->X_WP_place});
      failed_W.clear();
    } else {
      failed_W.push_back(plan.plan->X_WP_est * part.box_center_P);
    }
  }
}

}  // namespace binpick

#include "trials/sight.hpp"

#include "trials/oracle_stages.hpp"

namespace binpick {

EstimateResult estimate_view(const Scenario& s, const TrialContext& context, const SceneView& view,
                             const GroundTruth& truth, Seed seed) {
  return s.estimator ? s.estimator->estimate(view, seed) : oracle_estimate(truth, context.parts, s.oracle, seed);
}

void plan_sight(const Scenario& s, const TrialContext& context, const PickStart& start, Sight& sight,
                PickRecord& record) {
  if (sight.found.status != EstimateStatus::kFound) return;
  if (s.oracles.planning) {
    const TrueSight known = true_sight(sight.seen, sight.found);
    sight.plan = context.planner->plan(known.found, known.view, known.X_WC, start);
  } else {
    sight.plan = context.planner->plan(sight.found, sight.seen.view, sight.seen.X_WC_believed, start);
  }
  record.plan_wall += sight.plan.wall;
}

}  // namespace binpick

// What one look of a trial leads to: the view, the estimates, the plan.
#pragma once

#include "evaluation/trial_record.hpp"
#include "trials/observation.hpp"

namespace binpick {

struct Sight {
  Observation seen;
  EstimateResult found;  ///< in the C of seen.view
  PlanResult plan;       ///< meaningful when something was found
};

/// Only the oracle reads `truth`.
EstimateResult estimate_view(const Scenario& s, const TrialContext& context, const SceneView& view,
                             const GroundTruth& truth, Seed seed);

/// Plans by what was found, if anything was; the wall time is added to the record.
void plan_sight(const Scenario& s, const TrialContext& context, const PickStart& start, Sight& sight,
                PickRecord& record);

}  // namespace binpick

// One worker's tools, made once and used for many trials: parts, collision shapes, renderer, prepared estimator,
// pick planner, pose checker. Nothing in it remembers a trial.
#pragma once

#include <memory>
#include <vector>

#include "core/part.hpp"
#include "evaluation/matching.hpp"
#include "robot/plan_pick.hpp"
#include "sim/collision_shape.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/rest_check.hpp"
#include "trials/scenario.hpp"

namespace binpick {

struct TrialContext {
  std::vector<Part> parts;
  std::vector<CollisionShape> shapes;
  std::vector<int> counts;         ///< of each part, how many are dropped: the scene's, or what drop.fill makes of them
  std::vector<SolidProbe> probes;  ///< the parts' envelopes, for penetration at rest
  std::unique_ptr<DepthRenderer> renderer;
  std::unique_ptr<const PickPlanner> planner;           ///< knows where the tool fits on the parts
  std::unique_ptr<const PoseChecker> checker;           ///< the parts prepared for scoring
  std::shared_ptr<const CalibrationSetup> calibration;  ///< of a scene whose camera is calibrated by chain or hand_eye
  std::string hash;                                     ///< scenario_hash
};

/// How many of each part are dropped. Throws SpecError when drop.fill asks for too many.
std::vector<int> dropped_counts(const Scenario& scenario, const std::vector<Part>& parts);

/// Loads every asset, checks that the parts fit the bin, prepares the scenario's estimator. The scenario must outlive
/// the context and stay where it is: the planner refers to its cell. Throws SpecError, AssetError.
TrialContext make_trial_context(Scenario& scenario);

}  // namespace binpick

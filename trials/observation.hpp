// What a trial and `binpick render` share: the heap of a seed, and a look at it. The same seed gives the same bits in
// both.
#pragma once

#include <optional>
#include <vector>

#include "core/ground_truth.hpp"
#include "core/pose_estimate.hpp"
#include "sim/depth_sensor.hpp"
#include "trials/cell_world.hpp"
#include "trials/scenario.hpp"
#include "trials/trial_context.hpp"

namespace binpick {

struct Observation {
  SceneView view;                         ///< what the estimator is given
  Pose X_WC_believed = Pose::Identity();  ///< of the camera whose frame C the view is in
  GroundTruth truth;
  std::vector<Capture> captures;  ///< one a camera
  std::uint64_t frame_hash = 0;   ///< of all of them
};

/// The cell of a trial as it is built, where the scenario's is what it believes: they differ by the error of the
/// calibration, and not at all when that is perfect.
struct TrueCell {
  Cell cell;
  std::optional<Pose> X_CC;  ///< from where the (first) camera is to where it is believed; nothing: perfect
};
TrueCell true_cell(const Scenario& s, const TrialContext& context, Seed trial_seed);

/// The scenario's parts in the order in which they are dropped; `seed`: the trial's "drop".
std::vector<DropItem> drop_order(const Scenario& s, const TrialContext& context, Seed seed);

/// Drops the scenario's parts for the trial's seed and lets the arm come to the look pose.
DropResult drop_heap(const Scenario& s, const TrialContext& context, Seed trial_seed, CellWorld& cell_world);

/// Look number `pick` of the trial, from where the arm stands. Cameras are where the world's cell has them, and
/// believed to be where the scenario's has them.
Observation observe(const Scenario& s, const CellWorld& cell_world, TrialContext& context, Seed trial_seed, int pick);

/// The first camera once more before the same pick, from where the arm stands now: another frame of the same camera.
Capture capture_again(const Scenario& s, const CellWorld& cell_world, TrialContext& context, Seed trial_seed, int pick);

}  // namespace binpick

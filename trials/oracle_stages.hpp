// Stages of a trial that are told the truth, for the error budget (`binpick budget`): what would be gained if they were
// perfect. The pose estimator's own oracle is `estimator: {type: oracle}`, the sensor's `sensor: {type: ideal}`, the
// calibration's `calibration: perfect`; these are the other three. Written into a scenario only where one is on, so
// that scenes without any keep their hash.
#pragma once

#include <memory>
#include <span>

#include "core/pose_estimate.hpp"
#include "trials/observation.hpp"

namespace binpick {

/// Pixels of parts in the first look, as the renderer knows them. One camera only: a fused cloud has no pixels.
std::shared_ptr<const Image<std::uint8_t>> true_segmentation(const Observation& seen);

/// What a planner that knows the heap would see: exact depth of the latest frame of the (one) camera, from where it
/// truly stands, and the same estimates as seen from there. Without arm and tool.
struct TrueSight {
  SceneView view;
  EstimateResult found;
  Pose X_WC = Pose::Identity();
};
TrueSight true_sight(const Observation& seen, const EstimateResult& found);

/// Every cup seals that touches a part: most of its probes meet it, the nearest within the lip's reach. Changes
/// `contact` to that.
void seal_what_touches(const CellWorld& cell, std::span<const SurfaceSample> samples, Contact& contact);

}  // namespace binpick

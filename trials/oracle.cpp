#include "trials/oracle.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace binpick {

void OracleConfig::visit(ConfigVisitor& v) {
  v.field("translation_error", translation_error, Unit::kLength, "standard deviation of the error, per camera axis");
  v.field("rotation_error", rotation_error, Unit::kAngle, "standard deviation of the error, per axis");
  v.field("min_visible", min_visible, Unit::kNone, "instances with a smaller visible fraction are not reported");
}

void OracleConfig::validate() const {
  if (!(translation_error >= 0) || !(rotation_error >= 0))
    throw SpecError("estimator: the oracle's errors must not be negative");
  if (!(min_visible >= 0 && min_visible <= 1)) throw SpecError("estimator.min_visible: must lie between 0 and 1");
}

EstimateResult oracle_estimate(const GroundTruth& truth, std::span<const Part> parts, const OracleConfig& config,
                               Seed seed) {
  EstimateResult result;
  for (const GroundTruth::Instance& instance : truth.instances) {
    if (instance.visible_fraction < config.min_visible) continue;
    Rng rng = seed.child("oracle", instance.body).rng();
    Vector6d disturbance;
    for (int i = 0; i < 6; ++i)
      disturbance[i] = rng.normal(0, i < 3 ? config.translation_error : config.rotation_error);
    // The error acts at the part's middle: about the CAD origin, a rotation error would move a part drawn far from it.
    const Pose X_PM(Eigen::Translation3d(parts[instance.part].box_center_P));
    PoseEstimate estimate;
    estimate.part = instance.part;
    estimate.X_CP = truth.X_WC.inverse() * instance.X_WP * X_PM * exp_se3(disturbance) * X_PM.inverse();
    estimate.score = instance.visible_fraction;
    estimate.inlier_fraction = 1;
    result.estimates.push_back(estimate);
  }
  std::stable_sort(result.estimates.begin(), result.estimates.end(),
                   [](const PoseEstimate& a, const PoseEstimate& b) { return a.score > b.score; });
  result.status = result.estimates.empty() ? EstimateStatus::kNothingFound : EstimateStatus::kFound;
  return result;
}

}  // namespace binpick

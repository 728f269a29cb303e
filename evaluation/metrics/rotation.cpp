// rotation [rad]: angle of the rotation that carries the estimate into the truth, least over the part's symmetries
// (a continuous axis in closed form). 0 .. pi; a sphere has none.
#include "evaluation/metric.hpp"

namespace binpick {
namespace {

class RotationMetric : public Metric {
 public:
  double error(const Pose& X_WP_est, const Pose& X_WP_true, const ScoringModel& model) const override {
    const Pose X_WP_twin = nearest_equivalent(X_WP_true, X_WP_est, model.symmetry());
    return angle_between(X_WP_est.linear(), X_WP_twin.linear());
  }
};

}  // namespace

std::unique_ptr<Metric> make_rotation_metric() { return std::make_unique<RotationMetric>(); }

}  // namespace binpick

// add [m]: mean distance of corresponding model points (ADD, Hinterstoisser et al., ACCV 2012), against the symmetric
// twin of the truth that is nearest in rotation. Model points are the mesh's distinct vertices (at most
// ScoringModel::kMeanPoints of them): a finely meshed corner weighs more than a coarse face.
#include "evaluation/metric.hpp"

namespace binpick {
namespace {

class AddMetric : public Metric {
 public:
  double error(const Pose& X_WP_est, const Pose& X_WP_true, const ScoringModel& model) const override {
    const Pose X_WP_twin = nearest_equivalent(X_WP_true, X_WP_est, model.symmetry());
    double sum = 0;
    for (const Eigen::Vector3d& point_P : model.mean_points_P())
      sum += (X_WP_est * point_P - X_WP_twin * point_P).norm();
    return sum / static_cast<double>(model.mean_points_P().size());
  }
};

}  // namespace

std::unique_ptr<Metric> make_add_metric() { return std::make_unique<AddMetric>(); }

}  // namespace binpick

// add_s [m]: mean distance of the true model points to the nearest estimated one (ADD-S, also ADI; Hinterstoisser et
// al., ACCV 2012). The truth is taken at its symmetric twin nearest in rotation, so that the facets of a turned ring do
// not count as an error. Means run over ScoringModel::mean_points_P, nearest points are sought among all vertices.
#include "evaluation/metric.hpp"

namespace binpick {
namespace {

class AddSMetric : public Metric {
 public:
  double error(const Pose& X_WP_est, const Pose& X_WP_true, const ScoringModel& model) const override {
    const Pose X_WP_twin = nearest_equivalent(X_WP_true, X_WP_est, model.symmetry());
    const Pose X_PestPtrue = X_WP_est.inverse() * X_WP_twin;
    double sum = 0;
    for (const Eigen::Vector3d& point_P : model.mean_points_P()) {
      sum += model.vertices_P().distance(X_PestPtrue * point_P);
    }
    return sum / static_cast<double>(model.mean_points_P().size());
  }
};

}  // namespace

std::unique_ptr<Metric> make_add_s_metric() { return std::make_unique<AddSMetric>(); }

}  // namespace binpick

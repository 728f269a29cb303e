#include <cmath>
#include <numbers>

#include "evaluation/matching.hpp"
#include "evaluation/metric.hpp"

namespace binpick {
namespace {

double measure(const char* name, const Pose& X_WP_est, const Pose& X_WP_true, const ScoringModel& model) {
  return make_metric(name)->error(X_WP_est, X_WP_true, model);
}

}  // namespace

PoseError pose_error(const Pose& X_WP_est, const Pose& X_WP_true, const ScoringModel& model) {
  const Pose X_WP_twin = nearest_equivalent(X_WP_true, X_WP_est, model.symmetry());
  const Eigen::Vector3d turned = rpy_of(X_WP_est.linear()) - rpy_of(X_WP_twin.linear());
  PoseError error;
  error.mssd = measure("mssd", X_WP_est, X_WP_true, model);
  error.add_s = measure("add_s", X_WP_est, X_WP_true, model);
  error.translation = measure("translation", X_WP_est, X_WP_true, model);
  error.rotation = measure("rotation", X_WP_est, X_WP_true, model);
  error.abs_xyz = (X_WP_est * model.box_center_P() - X_WP_twin * model.box_center_P()).cwiseAbs();
  for (int i = 0; i < 3; ++i) error.abs_rpy[i] = std::abs(std::remainder(turned[i], 2 * std::numbers::pi));
  return error;
}

PoseError pose_error(const Pose& X_WP_est, const Pose& X_WP_true, const Part& part) {
  return pose_error(X_WP_est, X_WP_true, ScoringModel(part));
}

}  // namespace binpick

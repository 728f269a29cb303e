#include "perception/pose_covariance.hpp"

#include <Eigen/Cholesky>
#include <numbers>

namespace binpick {

Matrix6d pose_covariance(const PoseInformation& information) {
  Vector6d next_to_nothing;  // 1 m and half a turn
  next_to_nothing << 1, 1, 1, Eigen::Vector3d::Constant(1 / (std::numbers::pi * std::numbers::pi));
  const Matrix6d prior = next_to_nothing.asDiagonal();
  const Matrix6d H = information.surface + information.outline + prior;
  const Matrix6d noise =
      information.surface_variance * information.surface + information.outline_variance * information.outline + prior;
  const Matrix6d inverse = H.ldlt().solve(Matrix6d::Identity());
  const Matrix6d covariance = inverse * noise * inverse.transpose() + information.bias * information.bias.transpose();
  return (covariance + covariance.transpose()) / 2;
}

}  // namespace binpick

#include "core/pose.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// V of the SE(3) exponential: translation = V * rho.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  const Eigen::Matrix3d K = skew(rotation);
  if (angle < 1e-6) return Eigen::Matrix3d::Identity() + 0.5 * K + K * K / 6;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / a2 * K +
         (angle - std::sin(angle)) / (a2 * angle) * K * K;
}

}  // namespace

Pose pose_from(const Eigen::Matrix3d& R_AB, const Eigen::Vector3d& p_AB) {
  Pose X_AB = Pose::Identity();
  X_AB.linear() = R_AB;
  X_AB.translation() = p_AB;
  return X_AB;
}

Pose pose_from_xyz_rpy(const Eigen::Vector3d& p_AB, const Eigen::Vector3d& rpy) {
  const Eigen::Matrix3d R =
      (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return pose_from(R, p_AB);
}

Eigen::Vector3d rpy_of(const Eigen::Matrix3d& R) {
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  // Within 1e-9 of the pole roll and yaw turn about one axis: roll is set to 0 and yaw takes the turn.
  if (std::hypot(R(0, 0), R(1, 0)) < 1e-9) return {0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

Eigen::Vector3d stored_rpy(const Eigen::Matrix3d& R_AB) {
  Eigen::Vector3d rpy = rpy_of(R_AB);
  for (double& angle : rpy) angle = std::round(angle * 1e12) / 1e12;
  return rpy;
}

Pose stored_pose(const Pose& X_AB) { return pose_from_xyz_rpy(X_AB.translation(), stored_rpy(X_AB.linear())); }

Eigen::Vector3d log_so3(const Eigen::Matrix3d& R) {
  // Through the quaternion: accurate near 0 (no acos of a number near 1) and near pi.
  Eigen::Quaterniond q(R);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double s = q.vec().norm();
  if (s < 1e-12) return 2 * q.vec();
  return 2 * std::atan2(s, q.w()) / s * q.vec();
}

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity() + skew(rotation);
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

Pose exp_se3(const Vector6d& twist) {
  const Eigen::Vector3d rotation = twist.tail<3>();
  return pose_from(exp_so3(rotation), left_jacobian(rotation) * twist.head<3>());
}

Vector6d log_se3(const Pose& X_AB) {
  const Eigen::Vector3d rotation = log_so3(X_AB.linear());
  Vector6d twist;
  twist << left_jacobian(rotation).partialPivLu().solve(X_AB.translation()), rotation;
  return twist;
}

double angle_between(const Eigen::Matrix3d& R_1, const Eigen::Matrix3d& R_2) {
  return log_so3(R_1.transpose() * R_2).norm();
}

double distance_between(const Pose& X_1, const Pose& X_2) { return (X_1.translation() - X_2.translation()).norm(); }

Eigen::Matrix3d rotation_with_z(const Eigen::Vector3d& z_A) {
  const Eigen::Vector3d z = z_A.normalized();
  // The world axis least along z gives x: stable, and the same for the same input.
  Eigen::Index least;
  z.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d x = Eigen::Vector3d::Unit(least).cross(z).normalized();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return R;
}

Pose orthonormalised(const Pose& X_AB) {
  return pose_from(Eigen::Quaterniond(X_AB.linear()).normalized().toRotationMatrix(), X_AB.translation());
}

bool is_rigid(const Pose& X_AB, double tolerance) {
  const Eigen::Matrix3d R = X_AB.linear();
  if (!R.allFinite() || !X_AB.translation().allFinite()) return false;
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= tolerance &&
         std::abs(R.determinant() - 1) <= tolerance;
}

}  // namespace binpick

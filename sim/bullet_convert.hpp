// Private to sim: values between Eigen and Bullet. The scale is 1 (SI, double precision); P and M are handled by the
// bodies.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "core/pose.hpp"

namespace binpick {

inline btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Vector3d from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

inline btTransform to_bullet(const Pose& X) {
  const Eigen::Matrix3d& R = X.linear();
  const btMatrix3x3 basis(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2));
  return btTransform(basis, to_bullet(Eigen::Vector3d(X.translation())));
}

inline Pose from_bullet(const btTransform& X) {
  Pose result = Pose::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) result.linear()(row, column) = X.getBasis()[row][column];
  result.translation() = from_bullet(X.getOrigin());
  return result;
}

}  // namespace binpick

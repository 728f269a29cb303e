// Private to robot: a pose as urdfdom holds it.
#pragma once

#include <urdf_model/pose.h>

#include "core/pose.hpp"

namespace binpick {

inline Pose pose_of(const urdf::Pose& pose) {
  double x, y, z, w;
  pose.rotation.getQuaternion(x, y, z, w);
  Pose X = Pose::Identity();
  X.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  X.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return X;
}

}  // namespace binpick

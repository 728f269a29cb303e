#include "core/point_cloud.hpp"

#include <cmath>

namespace binpick {

PointCloud transformed(const Pose& X_AB, const PointCloud& cloud_B) {
  PointCloud cloud_A = cloud_B;
  for (Eigen::Vector3d& p : cloud_A.points) p = X_AB * p;
  for (Eigen::Vector3d& n : cloud_A.normals) n = X_AB.linear() * n;
  return cloud_A;
}

PointCloud unproject(const DepthFrame& frame) {
  PointCloud cloud_C;
  for (int v = 0; v < frame.depth.height(); ++v)
    for (int u = 0; u < frame.depth.width(); ++u)
      if (const double z = frame.depth(u, v); std::isfinite(z)) cloud_C.points.push_back(frame.camera.unproject(u, v, z));
  return cloud_C;
}

}  // namespace binpick

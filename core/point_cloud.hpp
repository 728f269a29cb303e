// Point clouds. A cloud carries its frame in its name: cloud_C, model_P.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/depth_frame.hpp"
#include "core/pose.hpp"

namespace binpick {

struct PointCloud {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;  ///< empty, or as many as points

  std::size_t size() const { return points.size(); }
  bool has_normals() const { return !points.empty() && normals.size() == points.size(); }
};

/// Points and normals of frame B in frame A.
PointCloud transformed(const Pose& X_AB, const PointCloud& cloud_B);

/// Every pixel with a return as a point of C, row by row, without normals.
PointCloud unproject(const DepthFrame& frame);

}  // namespace binpick

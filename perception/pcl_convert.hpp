// Private to perception's .cpp files: clouds to PCL's types.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "core/point_cloud.hpp"

namespace binpick {

inline pcl::PointCloud<pcl::PointXYZ>::Ptr to_pcl(const PointCloud& cloud) {
  auto out = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  out->reserve(cloud.size());
  for (const Eigen::Vector3d& p : cloud.points)
    out->push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  return out;
}

}  // namespace binpick

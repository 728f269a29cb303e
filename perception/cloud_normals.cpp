#include <pcl/features/normal_3d.h>
#include <pcl/search/kdtree.h>

#include <algorithm>

#include "perception/normals.hpp"
#include "perception/pcl_convert.hpp"

namespace binpick {

std::vector<Eigen::Vector3d> cloud_normals(const PointCloud& cloud_C, double radius) {
  std::vector<Eigen::Vector3d> out(cloud_C.size(), Eigen::Vector3d::Zero());
  if (cloud_C.size() < 3) return out;
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(to_pcl(cloud_C));
  estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setRadiusSearch(radius);
  estimation.setViewPoint(0, 0, 0);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Eigen::Vector3d n = normals[i].getNormalVector3fMap().cast<double>();
    if (n.allFinite() && n.norm() > 0.5) out[i] = n.normalized();
  }
  return out;
}

double median_spacing(const PointCloud& cloud) {
  if (cloud.size() < 2) return 0;
  const auto points = to_pcl(cloud);
  pcl::search::KdTree<pcl::PointXYZ> tree(false);
  tree.setInputCloud(points);
  std::vector<float> nearest;
  pcl::Indices index(2);
  std::vector<float> squared(2);
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / 2000);
  for (std::size_t i = 0; i < cloud.size(); i += step)
    if (tree.nearestKSearch((*points)[i], 2, index, squared) == 2) nearest.push_back(std::sqrt(squared[1]));
  if (nearest.empty()) return 0;
  std::nth_element(nearest.begin(), nearest.begin() + nearest.size() / 2, nearest.end());
  return nearest[nearest.size() / 2];
}

}  // namespace binpick

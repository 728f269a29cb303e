// Surface normals of a scene (paper 3.1): plane through the neighbours, turned to the camera, kept only where the
// neighbours' normals agree (eq. 3). In an image the neighbours are a window without depth jumps, and the plane is fitted
// to the inverse depth, in which it is linear and a stereo camera's noise is even (instead of the eigenvectors of eq. 1
// and 2); in a cloud without order they come from PCL's search tree by eq. 1 and 2. Frame C, metres.
#pragma once

#include "core/config.hpp"
#include "core/point_cloud.hpp"
#include "perception/scene.hpp"

namespace binpick {

struct NormalsConfig {
  double radius = 0.007;   ///< m, neighbourhood; several times the sensor's lateral resolution
  double agreement = 0.6;  ///< rad, largest angle to the neighbours' mean normal (paper eq. 3)

  void visit(ConfigVisitor& v);
  void validate() const;
};

/// Normals of the wanted pixels; zero where fewer than six neighbours or the agreement fails.
void estimate_normals(Scene& scene, const NormalsConfig& config);

/// Eq. 3 alone: clears the normals of wanted pixels that disagree with their neighbourhood.
void drop_disagreeing_normals(Scene& scene, const NormalsConfig& config);

/// Normals of an unordered cloud by PCL (eq. 1, 2), towards the origin of C.
std::vector<Eigen::Vector3d> cloud_normals(const PointCloud& cloud_C, double radius);

/// Median distance from a point to its nearest neighbour (PCL), m; 0 for fewer than two points.
double median_spacing(const PointCloud& cloud);

}  // namespace binpick

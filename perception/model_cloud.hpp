// CAD -> the points a camera can see from outside (paper 2): uniform samples of the mesh, hidden-point removal from six
// viewpoints along the part's axes, union of the six. Balls and cage inside a bearing vanish. Frame P, metres, with the
// mesh's outward normals.
#pragma once

#include "core/config.hpp"
#include "core/mesh.hpp"
#include "core/point_cloud.hpp"

namespace binpick {

struct ModelCloudConfig {
  double spacing = 0.02;       ///< of the diameter, between samples; half the voxel of paper 3.1
  double view_distance = 1.5;  ///< of the diameter, from the box's centre: near enough to look into bores
  double radius_factor = 50;   ///< Katz: sphere radius / largest distance. At this spacing 50 keeps 98 % of a ring's
                               ///< visible points and lets 0.6 % of the hidden ones through; 300 shows inner balls
  bool covisible = false;      ///< only pairs of points that some view shows together (perception/covisibility)

  void visit(ConfigVisitor& v);
  void validate() const;
};

/// The union of the six views, in the order of the samples.
PointCloud model_cloud(const TriangleMesh& mesh_P, double diameter, const ModelCloudConfig& config);

}  // namespace binpick

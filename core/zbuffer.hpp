// Depth and ids of meshes at poses, in fixed order and double precision: for verification, visibility, VSD and overlays.
// The sensor's renderer is sim's; this one has no GL.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/mesh.hpp"
#include "core/pose.hpp"

namespace binpick {

struct DepthIds {
  Image<float> depth;            ///< z of C in m; +infinity where nothing is
  Image<std::int32_t> ids;       ///< -1 where nothing is
};

class ZBuffer {
 public:
  ZBuffer(const PinholeCamera& camera, double near = 0.01);
  /// Draws a mesh; at equal depth the earlier one stays. Triangles that cross the near plane are clipped.
  void draw(const TriangleMesh& mesh_O, const Pose& X_CO, std::int32_t id);
  const DepthIds& result() const { return out_; }
  void clear();

 private:
  void draw_triangle(const Eigen::Vector3d& a_C, const Eigen::Vector3d& b_C, const Eigen::Vector3d& c_C, std::int32_t id);
  PinholeCamera camera_;
  double near_;
  DepthIds out_;
};

}  // namespace binpick

// Depth and ids of meshes at poses, in fixed order and double precision: for verification, visibility, VSD and
// overlays. The sensor's renderer is sim's; this one has no GL.
//
// Pixel (u, v) samples the ray through its centre, which lies at the integer coordinates (u, v) of PinholeCamera. 1/z
// is linear over the image of a triangle, so depth is exact at the sample. A pixel belongs to a triangle when left <= u
// < right and top <= v < bottom: neighbours that share an edge neither overlap nor leave a gap. Both sides of a
// triangle are drawn.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/mesh.hpp"
#include "core/pose.hpp"

namespace binpick {

struct DepthIds {
  Image<float> depth;       ///< z of C in m; +infinity where nothing is
  Image<std::int32_t> ids;  ///< -1 where nothing is
};

/// Pixels u0 <= u < u1, v0 <= v < v1.
struct PixelRect {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  bool empty() const { return u0 >= u1 || v0 >= v1; }
  int width() const { return empty() ? 0 : u1 - u0; }
  int height() const { return empty() ? 0 : v1 - v0; }
  bool operator==(const PixelRect&) const = default;
};

class ZBuffer {
 public:
  explicit ZBuffer(const PinholeCamera& camera, double near = 0.01);
  /// Draws a mesh; at equal depth the earlier one stays. Triangles that cross the near plane are clipped.
  void draw(const TriangleMesh& mesh_O, const Pose& X_CO, std::int32_t id);
  const DepthIds& result() const { return out_; }
  /// Forgets everything drawn; costs only the pixels of dirty().
  void clear();

  /// From now on only pixels inside `window` (cut to the image) are drawn; it does not clear.
  void restrict_to(const PixelRect& window);
  /// A rectangle that holds every pixel written since the last clear; empty when there is none. Whoever draws one part
  /// many times reads and clears this rectangle instead of the image.
  const PixelRect& dirty() const { return dirty_; }
  const PinholeCamera& camera() const { return camera_; }

 private:
  struct ScreenPoint {
    double u, v, inverse_z;
  };
  void draw_triangle(const Eigen::Vector3d& a_C, const Eigen::Vector3d& b_C, const Eigen::Vector3d& c_C,
                     std::int32_t id);
  void fill(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c, std::int32_t id);
  struct InversePlane;
  void fill_row(const InversePlane& plane, int v, int first, int end, std::int32_t id);
  ScreenPoint to_screen(const Eigen::Vector3d& p_C) const;

  PinholeCamera camera_;
  double near_;
  DepthIds out_;
  PixelRect window_;
  PixelRect dirty_;
  std::vector<Eigen::Vector3d> points_C_;  // scratch of draw(), kept to save allocations
  std::vector<ScreenPoint> screen_;
};

}  // namespace binpick

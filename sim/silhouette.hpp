// Private to sim: how many pixels a mesh alone would cover, what lies outside the image included. Triangles are
// projected and filled in double; a pixel belongs to a triangle when left <= u < right and top <= v < bottom of its
// centre.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/camera.hpp"
#include "core/mesh.hpp"
#include "core/pose.hpp"

namespace binpick {

/// Columns (or rows) that a mesh covers, one pixel wider on both sides; at most kMaxSide around the image.
struct PixelSpan {
  static constexpr int kMaxSide = 4096;
  double low = 1e9, high = -1e9;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  int first(int size) const { return static_cast<int>(std::floor(std::max(low, -double(kMaxSide - size) / 2))) - 1; }
  int last(int size) const { return static_cast<int>(std::ceil(std::min(high, double(kMaxSide + size) / 2))) + 1; }
};

/// Nothing when some vertex does not lie in front of the camera: such a mesh needs a renderer that clips.
std::optional<int> silhouette_pixels(const TriangleMesh& mesh_O, const Pose& X_CO, const PinholeCamera& camera);

}  // namespace binpick

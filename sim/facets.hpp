// Private to sim: from "which triangle does this pixel see" to depth, ids and normals. A renderer only says which
// triangle comes first in each pixel; depth is that triangle's plane met by the pixel's ray, in double: the same for
// every renderer, exact to the rounding of a float, and free of the graphics library's arithmetic.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/mesh.hpp"
#include "sim/depth_renderer.hpp"

namespace binpick {

/// What is known of a mesh before it is drawn.
struct MeshFacets {
  explicit MeshFacets(const TriangleMesh& mesh_O);
  std::vector<Eigen::Vector4d> planes_O;  ///< unit normal n and n . p of every triangle
  Eigen::AlignedBox3d box_O;
  bool closed = false;  ///< with outward normals: seen from outside, no back side shows
};

/// The first triangle in a pixel; item -1 where nothing is.
struct FacetId {
  std::int32_t item = -1, triangle = 0;
};

struct FacetView {
  const RenderScene& scene;
  const PinholeCamera& camera;
  double near, far;                       ///< m
  std::vector<Pose> X_CO;                 ///< by item
  std::vector<const MeshFacets*> facets;  ///< by item; null for an item that is not drawn
  int threads = 1;
};

/// Some corner of the item's box may lie in the picture, between near and far.
bool may_be_seen(const FacetView& view, std::size_t item);

/// The item is closed and wholly behind the near plane: its back faces cannot be seen.
bool hides_its_back(const FacetView& view, std::size_t item);

ExactFrame frame_of(const FacetView& view, const Image<FacetId>& seen);

}  // namespace binpick

// Convex hulls for collision: thinned out to few vertices, or inset by a margin. Metres.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/mesh.hpp"

namespace binpick {

/// Hull of at most `max_vertices` of the points; fewer when no point lies farther than `tolerance` outside.
TriangleMesh simplified_hull(const std::vector<Eigen::Vector3d>& points, std::size_t max_vertices, double tolerance);

/// The hull with every face moved inwards by `inset`, or by less where the solid is too thin for it.
struct InsetHull {
  std::vector<Eigen::Vector3d> vertices;
  double inset = 0;  ///< m, what was really taken off
};
InsetHull inset_hull(const std::vector<Eigen::Vector3d>& points, double inset);

/// Volume enclosed by a closed mesh.
double enclosed_volume(const TriangleMesh& mesh);

}  // namespace binpick

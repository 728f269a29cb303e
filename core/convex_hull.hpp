// Convex hull of points through Qhull: the hull's vertices, and its surface as a closed mesh. Any length unit, any
// frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/mesh.hpp"

namespace binpick {

/// Indices (ascending) of the points on the hull. Points that span no volume (fewer than four, coplanar) all count.
std::vector<std::uint32_t> hull_indices(const std::vector<Eigen::Vector3d>& points);

/// Closed, outward oriented surface of the hull; empty when the points span no volume.
TriangleMesh convex_hull(const std::vector<Eigen::Vector3d>& points);

}  // namespace binpick

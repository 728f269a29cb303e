// What is put right in a triangle list before anything is computed from it: equal vertices become one, triangles
// without area and repeated triangles go, an inside-out solid is turned. Every repair is counted. Any length unit.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.hpp"

namespace binpick {

/// For every vertex the index of the first vertex at the same position (0 and -0 are the same).
std::vector<std::uint32_t> first_at_same_position(const std::vector<Eigen::Vector3d>& vertices);

/// Signed volume over the triangles (positive when they face outward), about the middle of the vertices.
double signed_volume(const TriangleMesh& mesh);

struct MeshRepairs {
  std::size_t dropped_triangles = 0;  ///< without area, or repeated
  std::size_t merged_vertices = 0;
  std::size_t turned_triangles = 0;  ///< that disagreed with their neighbours
  bool turned_inside_out = false;
};

/// Turns triangles until neighbours agree, when every edge has exactly two and the surface has two sides; otherwise
/// leaves all as they are. Connected pieces that disagreed with themselves then face outward. Returns how many were
/// turned.
std::size_t turn_to_neighbours(TriangleMesh& mesh);

/// Repairs `mesh` in place. Vertices closer than `weld_distance` in every coordinate may become one when that closes
/// the surface; exactly equal ones always do. Vertices that no triangle uses are dropped, order is kept.
MeshRepairs repair_mesh(TriangleMesh& mesh, double weld_distance);

}  // namespace binpick

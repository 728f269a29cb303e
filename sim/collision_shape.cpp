#include "sim/collision_shape.hpp"

#include "core/error.hpp"
#include "sim/kept_pieces.hpp"
#include "sim/reduced_hull.hpp"

namespace binpick {

CollisionShape collision_shape(const Part& part) {
  CollisionShape shape;
  const DecompositionLimits limits;
  for (const TriangleMesh& piece : part.pieces_P) {
    TriangleMesh hull = simplified_hull(piece.vertices, limits.max_vertices, limits.tolerance);
    if (hull.empty()) throw AssetError(part.name + ": a convex piece spans no volume");
    shape.pieces_P.push_back(std::move(hull));
  }
  if (shape.pieces_P.empty())
    shape.pieces_P = kept_decomposition(part.envelope_P.empty() ? part.mesh_P : part.envelope_P, limits,
                                        DiskCache::from_environment());
  if (shape.pieces_P.empty()) throw AssetError(part.name + ": the mesh spans no volume that could collide");
  return shape;
}

}  // namespace binpick

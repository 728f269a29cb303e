// A closed mesh as few convex pieces: HACD's clusters, then merging of neighbours while the merged hull adds little
// volume.
#pragma once

#include <vector>

#include "core/mesh.hpp"

namespace binpick {

struct DecompositionLimits {
  double convex_enough = 0.03;       ///< share of the hull's volume that may be air before a part is split at all
  double merge_excess = 0.006;       ///< share of the mesh's volume that one merge may add as air
  std::size_t max_pieces = 24;       ///< merging goes on, whatever it adds, until there are no more
  std::size_t max_vertices = 40;     ///< of one piece
  double tolerance = 1e-4;           ///< m, vertices nearer than this to a piece's faces may be left out
  std::size_t max_triangles = 3000;  ///< larger meshes are thinned on a grid before they are split
};

/// Empty when the mesh spans no volume.
std::vector<TriangleMesh> convex_decomposition(const TriangleMesh& mesh, const DecompositionLimits& limits = {});

}  // namespace binpick

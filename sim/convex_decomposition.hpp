// A closed mesh as few convex pieces. It is cut by planes along the axes and halfway between them, always where most
// air is inside a hull and where the cut leaves the least of it (planes through flat faces first, so that machined
// parts fall apart exactly); then neighbours are merged while the merged hull adds little. HACD, which Bullet's extras
// hold, was tried first: its clusters are patches of surface, and on a ring their hulls filled 10 % of the hole.
#pragma once

#include <vector>

#include "core/mesh.hpp"

namespace binpick {

struct DecompositionLimits {
  double convex_enough = 0.03;    ///< share of the mesh's volume that may be air before a part is cut at all
  double piece_air = 0.002;       ///< a piece with less air is left alone, share of the mesh's volume
  double merge_air = 0.003;       ///< air that the merges of one piece may add together, same unit
  std::size_t max_pieces = 24;    ///< merging goes on, whatever it adds, until there are no more
  std::size_t max_vertices = 64;  ///< of one piece
  double tolerance = 1e-4;        ///< m, vertices nearer than this to a piece's faces may be left out
  int cells = 56;                 ///< air is sampled on a grid with this many points along the longest edge
};

/// Empty when the mesh spans no volume.
std::vector<TriangleMesh> convex_decomposition(const TriangleMesh& mesh, const DecompositionLimits& limits = {});

}  // namespace binpick

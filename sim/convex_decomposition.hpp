// A closed mesh as few convex pieces. It is cut by planes along the axes and halfway between them, always where most
// air is inside a hull and where the cut leaves the least of it (planes through flat faces first, so that machined
// parts fall apart exactly); then hulls are merged, the cheapest pair first, while all the air together stays little.
// HACD, which Bullet's extras hold, was tried first: its clusters are patches of surface, and on a ring their hulls
// filled 10 % of the hole.
#pragma once

#include <vector>

#include "core/mesh.hpp"

namespace binpick {

struct DecompositionLimits {
  double convex_enough = 0.03;  ///< share of the mesh's volume that may be air before a part is cut at all
  double piece_air = 0.0005;    ///< a region with less air is not cut, share of the mesh's volume
  double aim_air = 0.03;        ///< regions are merged while all the air stays below this, same unit; then,
  double max_air = 0.045;       ///< down to `aim_pieces`, below this; then, down to `max_pieces`, whatever it costs
  std::size_t aim_pieces = 24;
  std::size_t max_pieces = 32;
  std::size_t max_vertices = 64;  ///< of one piece; twice as many when it loses more than `round_loss` by that
  double round_loss = 0.03;       ///< share of a piece's volume
  double tolerance = 1e-4;        ///< m, vertices nearer than this to a piece's faces may be left out
  int cells = 56;                 ///< air is sampled on a grid with this many points along the longest edge
};

/// Empty when the mesh spans no volume.
std::vector<TriangleMesh> convex_decomposition(const TriangleMesh& mesh, const DecompositionLimits& limits = {});

}  // namespace binpick

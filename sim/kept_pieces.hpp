// Decompositions kept on disk: the pieces of a mesh are computed once on a machine and read from then on, the same
// bits.
#pragma once

#include "core/disk_cache.hpp"
#include "sim/convex_decomposition.hpp"

namespace binpick {

/// As convex_decomposition, which is asked when the cache does not have the pieces.
std::vector<TriangleMesh> kept_decomposition(const TriangleMesh& mesh, const DecompositionLimits& limits,
                                             const DiskCache& cache);

/// Under what the pieces are kept: made of the mesh and of every limit.
CacheKey pieces_key(const TriangleMesh& mesh, const DecompositionLimits& limits);

}  // namespace binpick

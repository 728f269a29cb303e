// A part as convex pieces, in P. Pieces from part.yaml when it names some, otherwise a decomposition of the envelope.
#pragma once

#include <vector>

#include "core/part.hpp"
#include "core/primitive.hpp"

namespace binpick {

struct CollisionShape {
  std::vector<TriangleMesh> pieces_P;  ///< convex, closed
  std::vector<Primitive> solids_P;     ///< exact boxes, cylinders and balls beside them; no part of ours has any
};

/// Throws AssetError when no usable piece comes out.
CollisionShape collision_shape(const Part& part);

}  // namespace binpick

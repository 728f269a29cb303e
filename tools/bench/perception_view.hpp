// What can be wrong with a view in a real cell, made on purpose: a bin that stands elsewhere than believed, no bin
// known at all (floor and walls stay in the cloud), a cloud without pixels, a bin without parts, another part's heap.
#pragma once

#include <optional>

#include "core/part.hpp"
#include "core/pose_estimate.hpp"
#include "core/random.hpp"

namespace binpick {

struct ViewTrouble {
  double bin_offset = 0;               ///< m, how far the believed bin is off, in a random direction
  double bin_turn = 0;                 ///< rad, by how much it is turned, about a random axis through its centre
  bool no_bin = false;                 ///< the estimator is told of no bin
  bool as_cloud = false;               ///< points in random order in place of the depth image
  bool no_parts = false;               ///< the bin is empty
  std::optional<PartSpec> other_part;  ///< what is looked for in place of the scene's parts

  bool none() const { return bin_offset == 0 && bin_turn == 0 && !no_bin && !as_cloud && !no_parts && !other_part; }
};

/// The view as the troubled cell would give it.
SceneView troubled(SceneView view, const ViewTrouble& trouble, Seed seed);

}  // namespace binpick

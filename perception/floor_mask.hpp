// Thin parts that lie on the floor: where a part is hardly thicker than the sensor's noise, one pixel does not tell its
// top from the floor, but the mean of a few does. Frame C, metres.
#pragma once

#include "perception/scene.hpp"

namespace binpick {

struct LowCut {
  double height = 0;       ///< m above the floor: what lies higher on average is a part
  double low = 0;          ///< m: pixels higher than this stay as they are and count for nobody
  double wall_margin = 0;  ///< m off the walls, where nothing is marked
};

/// Unmarks the wanted pixels of a scene with a bin that are floor, and marks those that are not, by the mean height of
/// their neighbourhood.
void mark_low_pixels(Scene& scene, const LowCut& cut);

}  // namespace binpick

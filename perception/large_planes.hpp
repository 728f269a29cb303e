// A view without a known bin: floor, walls and table are still in it. No part can show one flat face that is larger
// than the part itself, so a plane with a connected piece that reaches farther than any wanted part is none of theirs.
// Planes by RANSAC (Fischler, Bolles 1981) over pixels with normals, three neighbours a sample. Frame C, metres.
#pragma once

#include "perception/scene.hpp"

namespace binpick {

/// Unmarks the wanted pixels of every such plane. `largest_part`: diameter of the largest wanted part, m. The same
/// scene gives the same answer: the samples come from a seed of their own.
void unmark_large_planes(Scene& scene, double largest_part);

}  // namespace binpick

// Walls that lean and dividers: what a box alone does not cut away. Frame C, metres.
#pragma once

#include "perception/scene.hpp"

namespace binpick {

/// Unmarks the wanted pixels of a scene with a bin that lie within `margin` (m) of a wall or a divider, or behind a
/// wall. The floor is not looked at.
void unmark_bin(Scene& scene, double margin);

}  // namespace binpick

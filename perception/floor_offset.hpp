// How far the sensor's disparity is off in this frame, read off the visible floor of a bin whose pose is known. A
// stereo camera's bias is nearly constant in disparity, so in inverse depth: 1/z_seen = 1/z_true + offset. Frame C,
// metres.
#pragma once

#include "perception/scene.hpp"

namespace binpick {

/// The offset (1/m): mean about the deepest clear mode of 1/z - 1/z_floor; 0 when the floor does not show clearly
/// or the offset exceeds `largest` (m, at the floor).
double floor_offset(const Scene& scene, double largest);

}  // namespace binpick

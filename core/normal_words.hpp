// Private to core: random words -> standard normal numbers, in single precision, many at once. Box-Muller on series of
// our own in place of libm: additions, multiplications, one division and one square root, all of which IEEE 754 rounds
// in one way, so that the bits are the same on every processor. Compiled for wide registers, hence free of Eigen.
#pragma once

#include <cstdint>

namespace binpick {

inline constexpr int kNormalLanes = 16;

/// For every lane: x, y = sqrt(-2 ln u) (cos, sin)(2 pi w), u of (0, 1] from `a` and w of [0, 1) from `b`. The largest
/// value is 6.66.
void normals_from_words(const std::uint32_t* a, const std::uint32_t* b, float* x, float* y);

}  // namespace binpick

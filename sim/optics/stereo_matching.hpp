// Dense matching of a rectified pair: OpenCV's semi-global matcher (three paths), its uniqueness, left-right, median
// and speckle tests, then a texture test of ours and a subpixel fit of ours (subpixel_fit.hpp).
#pragma once

#include <cstdint>

#include "core/image.hpp"

namespace binpick {

struct StereoMatching {
  int block = 7;                 ///< px, side of the matching window, odd
  int disparities = 128;         ///< searched: 0 .. disparities - 1
  int p1 = 8, p2 = 32;           ///< penalties of a step of one pixel and of more, for each pixel of the block
  int uniqueness = 10;           ///< per cent by which the best cost must win
  int left_right = 1;            ///< px, largest disagreement of the two directions
  int speckle_size = 60;         ///< px, smaller islands are removed
  double contrast = 3;           ///< grey levels, standard deviation in the block, below which nothing is matched
  double saturated_share = 0.5;  ///< of the block: with more pixels at 255 nothing is matched
};

/// Disparity of the left image in px, NaN = no match. What lies outside the right image is never matched.
Image<float> match_pair(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const StereoMatching& how,
                        int threads);

}  // namespace binpick

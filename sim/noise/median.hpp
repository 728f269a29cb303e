// 3 x 3 median over the matches of a neighbourhood, as stereo cameras smooth their disparity.
#pragma once

#include "core/image.hpp"

namespace binpick {

/// NaN stays NaN and takes no part; of an even number of values the smaller middle one is taken.
Image<float> median_3x3(const Image<float>& image, int threads = 1);

}  // namespace binpick

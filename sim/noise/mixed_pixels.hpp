// Mixed pixels: at an outline some pixels report a depth between foreground and background, as resampling in real
// cameras makes them (physical_models A1; the share is untuned).
#pragma once

#include "core/random.hpp"
#include "sim/noise/disparity_image.hpp"

namespace binpick {

/// A pixel of the foreground with a farther 4-neighbour becomes, with the given probability, a mixture of both
/// disparities.
void mix_outlines(const StereoView& view, double probability, const Rng& rng, DisparityImage& image);

}  // namespace binpick

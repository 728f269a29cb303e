// Where on the surfaces a stereo match really sits: lateral jitter of every sample, and foreground that grows over its
// outline because the matching window still holds it (physical_models A1 "edge fattening", A3.3).
#pragma once

#include <cstdint>

#include "core/random.hpp"
#include "sim/noise/disparity_image.hpp"

namespace binpick {

/// Samples each pixel at (u, v) + N(0, sigma) px in both directions. The disparity is that of the surface hit there, at
/// the displaced point: on a slope this is depth noise, at an outline it frays. Hidden surfaces give no match.
DisparityImage jittered_samples(const StereoView& view, double sigma, const Image<std::uint8_t>& hidden,
                                const Rng& rng);

/// A pixel takes the nearest surface within `radius` px (square window) when that stands before its own by more than
/// kDisparityStep; slopes and creases of one surface do not count. Also fills shadow next to its caster.
void grow_foreground(const StereoView& view, int radius, DisparityImage& image);

}  // namespace binpick

// Subpixel disparity: least squares of the grey-level difference over the matching window (Lucas and Kanade 1981, one
// unknown), started at the matcher's result. Steps of 1/16 px of the matcher are too coarse for a camera that delivers
// 1/32 px, and its three-point parabola pulls towards whole pixels. The cubic interpolation here leaves a ripple of
// less than 0.02 px.
#pragma once

#include <cstdint>

#include "core/image.hpp"
#include "sim/optics/stereo_matching.hpp"

namespace binpick {

/// NaN where the window tells nothing: the standard deviation of its grey levels is below `contrast`, or more than
/// `saturated_share` of its pixels are at the limit (what is left then is its outline).
void drop_plain(const Image<std::uint8_t>& left, const StereoMatching& how, Image<float>& disparity);

/// Refines every disparity by at most one pixel; where the fit runs further away there is no match.
void fit_subpixel(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, int block, Image<float>& disparity,
                  int threads);

}  // namespace binpick

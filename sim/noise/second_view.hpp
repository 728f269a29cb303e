// Which pixels a second device at +x of the camera cannot see: the right imager, or the pattern projector. The z-buffer
// is warped by the disparity and the nearest surface is kept. Beside a depth step that hides w = f B (1/z_near -
// 1/z_far) pixels of the background, on the left of the foreground only (physical_models A1).
#pragma once

#include <cstdint>

#include "sim/noise/disparity_image.hpp"

namespace binpick {

/// 1 where the device at `view.baseline` does not see the surface of that pixel, either because something stands before
/// it or (when `same_image`) because it lies left of the device's image.
Image<std::uint8_t> hidden_from_second_view(const StereoView& view, bool same_image);

}  // namespace binpick

// The part of a frame that a bin can fill: everything else costs time and says nothing. A crop of the image is a camera
// of its own, with another size and principal point. Frame C, metres and pixels.
#pragma once

#include "core/bin_spec.hpp"
#include "core/depth_frame.hpp"
#include "perception/bin_kernel.hpp"

namespace binpick {

/// Pixels [u0, u1) x [v0, v1).
struct PixelBox {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
};

/// p_B of the pixels of a camera, for the row kernels.
BinRays bin_rays(const PinholeCamera& camera, const Pose& X_CB);

/// The box about the projected bin, `margin` (m) wider on every side, and about every pixel whose point stands above
/// the rim within the walls, up to `headroom` (m). The whole image where the bin reaches behind the camera.
PixelBox pixels_of_bin(const DepthFrame& frame, const BinSpec& bin, const Pose& X_CB, double margin, double headroom);

/// The frame's camera and depth of those pixels; X_WC and noise stay.
DepthFrame cropped(const DepthFrame& frame, const PixelBox& box);

}  // namespace binpick

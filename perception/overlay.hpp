// Pictures of what was seen and of what was found in it: for people; they decide nothing. Frame C.
#pragma once

#include <span>
#include <vector>

#include "core/image_io.hpp"
#include "core/part.hpp"
#include "core/pose_estimate.hpp"

namespace binpick {

/// Colour-mapped depth: near is warm, far is cold, no return is black.
Image<Rgb> depth_picture(const DepthFrame& frame);

/// Outlines and tints of the estimates over a picture taken from the same camera, numbered best first.
Image<Rgb> overlay_picture(const Image<Rgb>& base, const DepthFrame& frame, const std::vector<PoseEstimate>& estimates,
                           std::span<const Part> parts);

}  // namespace binpick

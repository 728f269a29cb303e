// Small flat patches of a depth image: blocks of pixels in which the inverse depth is a plane (there planes of space
// stay planes, and a stereo camera's noise is even). A few thousand of them say where floor and walls are at a
// hundredth of the cost of the pixels, and with less noise. Frame C, metres.
#pragma once

#include <vector>

#include "perception/scene.hpp"

namespace binpick {

struct Surfel {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< where the ray of the block's middle meets the patch
  Eigen::Vector3d n = Eigen::Vector3d::Zero();  ///< unit, towards the camera
};

/// Blocks of about `size` (m) at the view's median depth, in the order of the image; those across an edge, a crease or
/// a hole are left out.
std::vector<Surfel> surfels_of(const Scene& scene, double size);

}  // namespace binpick

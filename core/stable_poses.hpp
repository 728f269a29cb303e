// How a part comes to rest on a floor when it is set down gently in any orientation: on a face of its convex hull over
// which its mass centre stands. Quasi-static, after Goldberg, Mirtich, Zhuang, Craig, Carlisle and Canny (1999): a face
// is struck with the solid angle it fills seen from the mass centre; one that does not hold topples over an edge onto
// its neighbour. Real drops shift mass towards the low poses. Frame P is the part's own.
#pragma once

#include <vector>

#include "core/mesh.hpp"
#include "core/pose.hpp"
#include "core/symmetry.hpp"

namespace binpick {

struct StablePose {
  double probability = 0;                              ///< of all the faces that are counted as one with it
  int faces = 1;                                       ///< how many: symmetric twins, and facets of one round side
  Eigen::Vector3d down_P = -Eigen::Vector3d::UnitZ();  ///< outward normal of the likeliest face
  double height = 0;                                   ///< m, of the mass centre over the floor
  double tilt = 0;               ///< rad, least angle by which the part must be turned before it leaves the pose
  Pose X_FP = Pose::Identity();  ///< F: z up, floor at z = 0, the mass centre over the origin
};

/// Likeliest first; probabilities add up to 1. `center_P` must lie inside the hull of the points. Faces that the part's
/// symmetry carries into each other are one pose, and so are neighbours over which it rolls (less than 20 degrees
/// apart, heights equal within 0.5 % of the size). Empty when the points span no volume.
std::vector<StablePose> stable_poses(const std::vector<Eigen::Vector3d>& points_P, const Eigen::Vector3d& center_P,
                                     const Symmetry& symmetry);

}  // namespace binpick

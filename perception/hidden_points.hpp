// Which points of a set can be seen from a viewpoint, without a surface (paper 2; Katz, Tal, Basri: Direct Visibility
// of Point Sets, 2007): every point is reflected at a sphere about the viewpoint; those on the convex hull of the
// reflected points and the viewpoint are visible. Right for dense samples of a closed surface; in narrow concavities it
// drops visible points, and a larger sphere keeps more of them but lets hidden ones through.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace binpick {

/// Indices, ascending, of the points visible from `viewpoint`. Sphere radius = `radius_factor` x the largest distance
/// (> 1). Fewer than four points, or points in one plane with the viewpoint: all are returned.
std::vector<std::size_t> visible_points(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& viewpoint,
                                        double radius_factor);

}  // namespace binpick

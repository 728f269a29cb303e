// Depth frames as clouds with normals, and several of them as one. Each frame's points are placed by its own believed
// X_WC; errors of those poses stay in the cloud.
#pragma once

#include <span>

#include "core/depth_frame.hpp"
#include "core/point_cloud.hpp"
#include "perception/normals.hpp"

namespace binpick {

/// Every pixel with a return, row by row, in the frame's own C; a normal (towards the camera) from the organised
/// neighbours, zero where they do not agree.
PointCloud cloud_with_normals(const DepthFrame& frame, const NormalsConfig& config);

}  // namespace binpick

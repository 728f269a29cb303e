// Depth frames as clouds with normals, and several of them as one. Each frame's points are placed by its own believed
// X_WC; errors of those poses stay in the cloud.
#pragma once

#include <optional>
#include <span>

#include "core/bin_spec.hpp"
#include "core/depth_frame.hpp"
#include "core/point_cloud.hpp"
#include "perception/normals.hpp"

namespace binpick {

/// Every pixel with a return, row by row, in the frame's own C; a normal (towards the camera) from the organised
/// neighbours, zero where they do not agree.
PointCloud cloud_with_normals(const DepthFrame& frame, const NormalsConfig& config);

/// A bin that the frames look into, as believed: its floor shows how far each camera's disparity is off, which is
/// removed before the points meet, as preprocess does for a single frame.
struct KnownBin {
  BinSpec spec;
  Pose X_WB = Pose::Identity();
  double largest_offset = 0.012;  ///< m at the floor; larger offsets are not believed
};

/// All frames' points in the C of the first, one frame after another, each placed by its own X_WC; normals towards the
/// camera that saw the point. Rounded to float, as a PLY holds them.
PointCloud fuse_frames(std::span<const DepthFrame> frames, const NormalsConfig& config,
                       const std::optional<KnownBin>& bin = std::nullopt);

}  // namespace binpick

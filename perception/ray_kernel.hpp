// Private to hypothesis_check.cpp: model points at a pose against the depth image along their rays, eight at a time.
// Plain numbers only, since the kernel is compiled for wide registers. Frame C, metres.
#pragma once

#include <cstdint>

namespace binpick {

/// Visible model points in P, `count` a multiple of 8; what fills up the last eight is NaN.
struct ModelPointsView {
  const float *x, *y, *z, *nx, *ny, *nz;
  int count = 0;
};

struct RayImage {
  const float* depth = nullptr;          ///< NaN = unknown
  const std::uint8_t* wanted = nullptr;  ///< same size
  const float* normals = nullptr;        ///< three a pixel, zero = none
  std::int32_t width = 0, height = 0;
  float fx = 0, fy = 0, cx = 0, cy = 0;
};

struct RayQuery {
  float R_CP[9], p_CP[3];  ///< row by row
  float least_facing = 0;  ///< cosine below which a point counts as not visible
  float least_slant = 0;   ///< cosine below which the tolerance grows no more
  float least_normal = 0;  ///< cosine of the normals' agreement
  // tolerance = widened max(floor, sigmas (constant + linear z + quadratic z^2)) / max(least_slant, facing)
  float widened = 1, floor = 0, sigmas = 0, constant = 0, linear = 0, quadratic = 0;
};

/// Every point weighs with its cosine: the area it covers in the image.
struct RaySums {
  float tried = 0, inliers = 0, occluded = 0, through = 0, unknown = 0, off = 0;
};

/// Adds the points to the sums.
void add_rays(const ModelPointsView& model, const RayImage& image, const RayQuery& query, RaySums& sums);

}  // namespace binpick

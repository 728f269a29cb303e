// Private to preprocessing: rows of a depth image against the bin, for wide registers. A pixel's point in the bin's
// frame is p_B = z (a + u b + v c) + t. Metres; free of Eigen.
#pragma once

#include <cstdint>

namespace binpick {

struct BinRays {
  float a[3], b[3], c[3], t[3];
};

/// A box in B about the z axis.
struct BinBox {
  float half_x = 0, half_y = 0;  ///< m
  float low = 0, high = 0;       ///< m above the floor
};

/// A row of the image: pixels (0, v) .. (count - 1, v).
struct DepthRow {
  const float* depth;
  int v, count;
};

/// inside[u] = 1 where the point lies inside the box, else 0 (unknown depth among them).
void mark_inside(const DepthRow& row, const BinRays& rays, const BinBox& box, std::uint8_t* inside);

/// First and last pixel of the row inside the box; false when there is none.
bool inside_span(const DepthRow& row, const BinRays& rays, const BinBox& box, int& first, int& last);

/// For every `stride`-th pixel: 1/z - 1/z_floor, or NaN where the ray misses the floor or the depth is unknown;
/// counts in `rays_on_floor` the rays that meet the floor within the box's sides. Returns how many values.
int floor_differences(const DepthRow& row, int stride, const BinRays& rays, const BinBox& box, float* out,
                      int& rays_on_floor);

}  // namespace binpick

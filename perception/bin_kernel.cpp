#include "perception/bin_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binpick {
namespace {

/// The row's part of the rays: direction in B of pixel u is start + u b.
struct RowRays {
  float start[3], b[3], t[3];
  RowRays(const BinRays& rays, int v) {
    for (int k = 0; k < 3; ++k) {
      start[k] = rays.a[k] + static_cast<float>(v) * rays.c[k];
      b[k] = rays.b[k];
      t[k] = rays.t[k];
    }
  }
};

}  // namespace

void mark_inside(const DepthRow& row, const BinRays& rays, const BinBox& box, std::uint8_t* __restrict inside) {
  const RowRays r(rays, row.v);
  const float* __restrict depth = row.depth;
  for (int u = 0; u < row.count; ++u) {
    const float z = depth[u], at = static_cast<float>(u);
    const float x = z * (r.start[0] + at * r.b[0]) + r.t[0], y = z * (r.start[1] + at * r.b[1]) + r.t[1],
                height = z * (r.start[2] + at * r.b[2]) + r.t[2];
    inside[u] = (z > 0) & (std::abs(x) < box.half_x) & (std::abs(y) < box.half_y) & (height > box.low) &
                (height < box.high);  // all false for NaN
  }
}

bool inside_span(const DepthRow& row, const BinRays& rays, const BinBox& box, int& first, int& last) {
  const RowRays r(rays, row.v);
  int low = row.count, high = -1;
  for (int u = 0; u < row.count; ++u) {
    const float z = row.depth[u], at = static_cast<float>(u);
    const float x = z * (r.start[0] + at * r.b[0]) + r.t[0], y = z * (r.start[1] + at * r.b[1]) + r.t[1],
                height = z * (r.start[2] + at * r.b[2]) + r.t[2];
    const bool inside =
        (z > 0) & (std::abs(x) < box.half_x) & (std::abs(y) < box.half_y) & (height > box.low) & (height < box.high);
    low = std::min(low, inside ? u : row.count);
    high = std::max(high, inside ? u : -1);
  }
  first = low;
  last = high;
  return high >= 0;
}

int floor_differences(const DepthRow& row, int stride, const BinRays& rays, const BinBox& box, float* __restrict out,
                      int& rays_on_floor) {
  const RowRays r(rays, row.v);
  const float* __restrict depth = row.depth;
  const int count = (row.count + stride - 1) / stride;
  const float per_height = -1 / r.t[2];
  int met = 0;
  for (int k = 0; k < count; ++k) {
    const float at = static_cast<float>(k * stride), z = depth[k * stride];
    const float inverse = (r.start[2] + at * r.b[2]) * per_height;  // 1/z of the floor: linear in u and v
    const float floor = 1 / std::max(inverse, 1e-9f);
    const float x = floor * (r.start[0] + at * r.b[0]) + r.t[0], y = floor * (r.start[1] + at * r.b[1]) + r.t[1];
    const bool on_floor = (inverse > 1e-6f) & (std::abs(x) <= box.half_x) & (std::abs(y) <= box.half_y);
    const bool known = on_floor & (z > 0);
    met += on_floor;
    out[k] = known ? 1 / z - inverse : std::numeric_limits<float>::quiet_NaN();
  }
  rays_on_floor += met;
  return count;
}

}  // namespace binpick

// Private to the normals: plane through the window of every wanted pixel of a row, for wide registers. A plane is
// linear in the image when the INVERSE depth is taken (1/z = (n_x X + n_y Y + n_z) / D with X = (u - cx) / fx ...), so
// that the fit is a regression in two variables, and it is unbiased, since that is also the domain in which a stereo
// camera's noise is even. Neighbours beyond a depth jump do not enter. Free of Eigen; metres.
#pragma once

#include <cstddef>
#include <cstdint>

namespace binpick {

constexpr int kNormalReach = 12;  ///< px, half of the largest window
constexpr int kNormalPad = 24;    ///< px of NaN that the kernel may read beside and above and below the row

struct NormalRule {
  float fx, fy, cx, cy;
  float radius;                                         ///< m, of the window
  float sigma_constant, sigma_linear, sigma_quadratic;  ///< stated noise: a jump is radius + 2 sigma
  int fewest = 6;                                       ///< neighbours for a plane
};

/// Row v of two padded planes: depth and inverse depth, NaN where unknown.
struct NormalRow {
  const float* depth;
  const float* inverse;
  std::ptrdiff_t pitch;        ///< floats from a row to the next
  const std::uint8_t* wanted;  ///< readable for 8 more than `width`
  int v, width;
};

/// Unit normals towards the camera, zero where not wanted or not enough neighbours; columns of at least width + 8.
struct NormalColumns {
  float *x, *y, *z;
};
void normals_of_row(const NormalRow& row, const NormalRule& rule, const NormalColumns& out);

}  // namespace binpick

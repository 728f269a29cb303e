// The formulas of the pair feature in single floats, free of Eigen, so that the wide kernel (pair_kernel.cpp) and the
// plain form (pair_feature.hpp) share them and give the same bits. Angles in radians, alpha in 1/65536 turns.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace binpick {

/// Cuts a feature (length, three angles) into cells of a dense table.
struct PairSteps {
  float per_metre = 200;      ///< 1 / step of the length
  float per_radian = 4.775f;  ///< 1 / step of the angles
  int length_bins = 1;
  int angle_bins = 1;
};

namespace pair_math {

constexpr float kPi = 3.14159265358979f;

/// a . b, summed from the left.
inline float dot(float ax, float ay, float az, float bx, float by, float bz) { return ax * bx + ay * by + az * bz; }

/// acos by a polynomial (Abramowitz & Stegun 4.4.45): within 7e-5 rad.
inline float unit_angle(float cosine) {
  const float x = std::min(std::abs(cosine), 1.0f);
  const float angle = std::sqrt(1 - x) * (1.5707288f + x * (-0.2121144f + x * (0.0742610f - 0.0187293f * x)));
  return cosine < 0 ? kPi - angle : angle;
}

/// atan2(z, y) by a polynomial (Abramowitz & Stegun 4.4.49, within 1e-5 rad), rounded to 1/65536 turns, 0 .. 65535.
inline int turns_of(float y, float z) {
  const float ay = std::abs(y), az = std::abs(z);
  const float t = std::min(ay, az) / std::max(std::max(ay, az), 1e-30f), s = t * t;
  float angle = t * (0.9998660f + s * (-0.3302995f + s * (0.1801410f + s * (-0.0851330f + s * 0.0208351f))));
  angle = az > ay ? kPi / 2 - angle : angle;
  angle = y < 0 ? kPi - angle : angle;
  angle = z < 0 ? 2 * kPi - angle : angle;
  return static_cast<int>(angle * (32768 / kPi) + 0.5f) & 0xffff;
}

inline int angle_bin(float angle, const PairSteps& steps) {
  return std::min(static_cast<int>(angle * steps.per_radian), steps.angle_bins - 1);
}

/// The cell of a feature; only meaningful for lengths up to length_bins.
inline int cell_of(int length_bin, int bin_1, int bin_2, int bin_n, const PairSteps& steps) {
  return ((length_bin * steps.angle_bins + bin_1) * steps.angle_bins + bin_2) * steps.angle_bins + bin_n;
}

}  // namespace pair_math
}  // namespace binpick

#include "sim/noise/depth_grid.hpp"

#include <cmath>
#include <limits>

namespace binpick {

float on_grid(double z, const DepthGrid& grid) {
  const double rounded = grid.unit > 0 ? std::round(z / grid.unit) * grid.unit : z;
  const auto delivered = static_cast<float>(rounded);
  // Compared after rounding, so that no delivered value lies outside. NaN fails both tests.
  const bool inside = delivered >= grid.z_min && delivered <= grid.z_max;
  return inside ? delivered : std::numeric_limits<float>::quiet_NaN();
}

float depth_of_disparity(double disparity, double step, double fB, const DepthGrid& grid) {
  const double d = step > 0 ? std::round(disparity / step) * step : disparity;
  return d > 0 ? on_grid(fB / d, grid) : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace binpick

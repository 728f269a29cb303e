// The last step of every sensor: depth in whole units, nothing outside the range.
#pragma once

namespace binpick {

struct DepthGrid {
  double unit = 0;   ///< m; 0: no rounding
  double z_min = 0;  ///< m
  double z_max = 0;  ///< m
};

/// The depth that is delivered for z; NaN for z = NaN and outside the range.
float on_grid(double z, const DepthGrid& grid);

}  // namespace binpick

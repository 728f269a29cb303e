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

/// The same for a disparity (px) that a stereo camera tells in steps (px; 0: none): z = f B / d, fB in m px. NaN for
/// NaN and for what is not in front of the camera.
float depth_of_disparity(double disparity, double step, double fB, const DepthGrid& grid);

}  // namespace binpick

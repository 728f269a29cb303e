// The image that the stereo terms work on: disparity d = f B / z in pixels (physical_models A1), with the exact pixel
// whose surface each value reports. Every surface is a plane in disparity: 1/z = (n . ray) / (n . p), linear over the
// image.
#pragma once

#include <cstdint>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "sim/depth_renderer.hpp"

namespace binpick {

/// A stereo camera looking at an exact frame. Frame C is the left imager; the right one stands `baseline` along +x.
struct StereoView {
  const ExactFrame& exact;
  const PinholeCamera& camera;
  double baseline;  ///< m

  double fB() const { return camera.fx * baseline; }  ///< m px
  std::size_t index(int u, int v) const { return static_cast<std::size_t>(v) * camera.width + u; }
  int column(std::size_t pixel) const { return static_cast<int>(pixel % camera.width); }
  int row(std::size_t pixel) const { return static_cast<int>(pixel / camera.width); }
  /// Exact disparity of a pixel; 0 where nothing is.
  double disparity(std::size_t pixel) const;
  /// Disparity at (u, v) of the plane seen in `pixel`, at most kMaxExtrapolation away from the pixel's own.
  double disparity_at(std::size_t pixel, double u, double v) const;
  /// Cosine of the angle between the surface normal and the ray, 0 .. 1.
  double cos_incidence(std::size_t pixel) const;

  static constexpr double kMaxExtrapolation = 2.0;  ///< px of disparity
};

struct DisparityImage {
  Image<float> disparity;      ///< px; NaN: no match
  Image<std::int32_t> source;  ///< pixel of the exact frame whose surface is reported; -1: none
};

/// Two neighbours belong to different surfaces when they differ by more than this beyond what their planes explain.
inline constexpr double kDisparityStep = 0.25;  // px; 4 mm at 0.6 m (D435, 848 x 480)

}  // namespace binpick

// The disparity domain of a stereo camera: d = f B / z (px), f the horizontal focal length, B the baseline. In it a
// stereo camera makes its errors, and in it every surface is a plane in disparity: 1/z = (n . ray) / (n . p), linear
// over the image.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "sim/depth_renderer.hpp"

namespace binpick {

/// A stereo camera looking at an exact frame. Frame C is the left imager; the right one stands `baseline` along +x.
/// Holds, for every pixel, the plane in disparity of what is seen there.
class StereoView {
 public:
  /// `baseline` in m; a term may use `threads`, its result does not depend on them.
  StereoView(const ExactFrame& exact, const PinholeCamera& camera, double baseline, int threads);

  const ExactFrame& exact;
  const PinholeCamera& camera;
  double baseline;  ///< m
  int threads;

  double fB() const { return camera.fx * baseline; }  ///< m px
  std::size_t index(int u, int v) const { return static_cast<std::size_t>(v) * camera.width + u; }
  /// Exact disparity of a pixel; 0 where nothing is.
  float disparity(std::size_t pixel) const { return planes_[pixel].d; }
  /// Disparity at (u, v) of the plane seen in `pixel`, at most kMaxExtrapolation away from the pixel's own.
  float disparity_at(std::size_t pixel, float u, float v) const {
    const auto row = static_cast<std::uint32_t>(pixel) / static_cast<std::uint32_t>(camera.width);
    const auto column = static_cast<std::uint32_t>(pixel) - row * static_cast<std::uint32_t>(camera.width);
    return disparity_beside(pixel, u - static_cast<float>(column), v - static_cast<float>(row));
  }
  /// The same, (du, dv) away from `pixel`.
  float disparity_beside(std::size_t pixel, float du, float dv) const {
    const Plane& plane = planes_[pixel];
    return plane.d + std::clamp(plane.along_u * du + plane.along_v * dv, -kMaxExtrapolation, kMaxExtrapolation);
  }
  /// Cosine of the angle between the surface normal and the ray, 0 .. 1.
  float cos_incidence(std::size_t pixel) const { return planes_[pixel].cos_incidence; }

  static constexpr float kMaxExtrapolation = 2.0f;  ///< px of disparity

 private:
  struct Plane {
    float d = 0, along_u = 0, along_v = 0;  ///< px, px per px
    float cos_incidence = 0;
  };
  Plane plane_of(int u, int v) const;

  Image<Plane> planes_;
};

struct DisparityImage {
  Image<float> disparity;      ///< px; NaN: no match
  Image<std::int32_t> source;  ///< pixel of the exact frame whose surface is reported; -1: none
};

/// Two neighbours belong to different surfaces when they differ by more than this beyond what their planes explain.
inline constexpr float kDisparityStep = 0.25f;  // px; 4 mm at 0.6 m (D435, 848 x 480)

}  // namespace binpick

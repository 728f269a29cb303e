// How good is a depth image of a flat wall? The measures of the RealSense depth-quality tool (physical_models A1), and
// the two that tell correlated noise from white. Depth is the z of frame C in m; NaN counts as missing. A measure of
// too few pixels is NaN.
#pragma once

#include <optional>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"

namespace binpick {

/// Columns u0 <= u < u1, rows v0 <= v < v1.
struct ImageRegion {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  int pixels() const { return (u1 - u0) * (v1 - v0); }
};

/// `width` x `height` pixels around the middle of the image, inside it.
ImageRegion centre_region(const PinholeCamera& camera, int width, int height);
/// The middle `share` of both sides.
ImageRegion centre_region(const PinholeCamera& camera, double share);

/// normal_C . p_C = offset; the normal is unit and points away from the camera, so that offset > 0.
struct WallPlane {
  Eigen::Vector3d normal_C = Eigen::Vector3d::UnitZ();
  double offset = 0;  ///< m
  /// Depth at which the ray through (u, v) meets the plane.
  double depth_at(const PinholeCamera& camera, double u, double v) const {
    return offset / normal_C.dot(camera.ray(u, v));
  }
};

/// Least squares of the distances of the region's points; nothing when fewer than ten are valid.
std::optional<WallPlane> fit_wall(const Image<float>& depth, const PinholeCamera& camera, const ImageRegion& region);

/// RMS distance of the points from their own plane, m.
double plane_fit_rms(const Image<float>& depth, const PinholeCamera& camera, const ImageRegion& region);

/// sqrt(mean (D_i - DP_i)^2) in px, D_i = f B / z_i and DP_i the same of the fitted plane.
double subpixel_rms(const Image<float>& depth, const PinholeCamera& camera, const ImageRegion& region, double baseline);

/// Median of (z - z_true) / z_true.
double z_accuracy(const Image<float>& depth, const Image<float>& truth, const ImageRegion& region);

/// Mean and RMS of z - z_true, m.
double mean_error(const Image<float>& depth, const Image<float>& truth, const ImageRegion& region);
double rms_error(const Image<float>& depth, const Image<float>& truth, const ImageRegion& region);

/// Share of the region that has depth.
double fill_rate(const Image<float>& depth, const ImageRegion& region);

/// Median over the pixels of (standard deviation over the frames / median over the frames); a pixel takes part when at
/// least half of the frames have it.
double temporal_noise(const std::vector<Image<float>>& frames, const ImageRegion& region);

/// Mean of the frames, pixel by pixel, over those that have it.
Image<float> frame_mean(const std::vector<Image<float>>& frames);

/// Autocorrelation of z - z_true along the rows at a lag in px; the mean error is taken off first.
double error_correlation(const Image<float>& depth, const Image<float>& truth, const ImageRegion& region, int lag);

}  // namespace binpick

// Lens distortion of a real camera beside the ideal pinhole: Brown-Conrady in the order k1 k2 p1 p2 k3 of most
// calibration programs. On coordinates of the plane z = 1 of C (x/z, y/z; no unit), r^2 = x^2 + y^2, m = 1 + k1 r^2 +
// k2 r^4 + k3 r^6:
//   x' = x m + 2 p1 x y + p2 (r^2 + 2 x^2)        y' = y m + p1 (r^2 + 2 y^2) + 2 p2 x y
// k1 < 0 is a barrel. Depth frames are rectified, so only grey images know it. Source: Brown 1971, Conrady 1919.
#pragma once

#include <Eigen/Core>

#include "core/camera.hpp"
#include "core/config.hpp"

namespace binpick {

struct LensDistortion {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

  bool none() const { return k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0 && k3 == 0; }
  /// Ideal (pinhole) coordinates to those where the lens puts them.
  Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const;
  /// The inverse, to 1e-10; meant for lenses that validate() lets through, inside their image.
  Eigen::Vector2d undistort(const Eigen::Vector2d& seen) const;

  void visit(ConfigVisitor& v);
  /// Throws SpecError when the image of `camera` holds a place that two directions would share: the lens folds there.
  void validate(const PinholeCamera& camera) const;

 private:
  Eigen::Matrix2d jacobian(const Eigen::Vector2d& ideal) const;
};

/// Pixel of a point of C (z > 0) through the lens.
Eigen::Vector2d project(const PinholeCamera& camera, const LensDistortion& lens, const Eigen::Vector3d& p_C);
/// Direction of C (z = 1) that the lens brings to a pixel.
Eigen::Vector3d ray(const PinholeCamera& camera, const LensDistortion& lens, double u, double v);

}  // namespace binpick

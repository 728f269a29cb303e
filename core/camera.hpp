// Pinhole camera. Frame C: x right, y down, z forward; pixel (0,0) is the centre of the first pixel; depth is the z of C.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/config.hpp"
#include "core/error.hpp"

namespace binpick {

struct PinholeCamera {
  int width = 848;
  int height = 480;
  double fx = 430.1;  ///< px (D435 at 848x480, physical_models A2)
  double fy = 430.1;  ///< px
  double cx = 423.5;  ///< px
  double cy = 239.5;  ///< px

  /// Point in C (z > 0) to pixel coordinates.
  Eigen::Vector2d project(const Eigen::Vector3d& p_C) const {
    return {fx * p_C.x() / p_C.z() + cx, fy * p_C.y() / p_C.z() + cy};
  }
  /// Pixel coordinates and depth to a point in C.
  Eigen::Vector3d unproject(double u, double v, double depth) const {
    return {(u - cx) / fx * depth, (v - cy) / fy * depth, depth};
  }
  /// Direction through a pixel, scaled to z = 1.
  Eigen::Vector3d ray(double u, double v) const { return unproject(u, v, 1.0); }

  void visit(ConfigVisitor& v) {
    v.field("width", width, "image width in pixels");
    v.field("height", height, "image height in pixels");
    v.field("fx", fx, Unit::kNone, "focal length in pixels, along x");
    v.field("fy", fy, Unit::kNone, "focal length in pixels, along y");
    v.field("cx", cx, Unit::kNone, "principal point in pixels, pixel (0,0) is the centre of the first pixel");
    v.field("cy", cy, Unit::kNone, "principal point in pixels");
  }
  void validate() const {
    if (width < 16 || height < 16 || width > 8192 || height > 8192)
      throw SpecError("camera: width and height must lie between 16 and 8192 pixels");
    if (!(fx > 0) || !(fy > 0)) throw SpecError("camera: fx and fy must be positive");
  }
};

}  // namespace binpick

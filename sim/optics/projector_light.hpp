// A pattern projector in the scene: which point of its pattern lights a surface, how strongly, and what is in its
// shadow. Shading is deferred: an exact frame gives every pixel's point, normal and material, and the light is worked
// out for that point on the CPU, so that nothing depends on shader code. Frames: C the camera, I an imager (the camera
// itself or a second one), D the projector, a pinhole device like them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/sensor_model.hpp"

namespace binpick {

/// One imager and what it sees.
struct ImagerView {
  const ExactFrame& frame;
  const PinholeCamera& camera;
  Pose X_CI = Pose::Identity();
};

/// The light that a pixel receives back.
struct PixelLight {
  double beam = 0;     ///< radiance per unit of pattern brightness, projector of power 1 (1/m^2); 0 in shadow
  double ambient = 0;  ///< radiance per unit of ambient irradiance
  Eigen::Vector2d pixel_D = Eigen::Vector2d::Zero();  ///< where on the pattern, in pixels of D
};

class ProjectorLight {
 public:
  /// `map` is the scene seen from D.
  ProjectorLight(const ExactFrame& map, const PinholeCamera& device, const Pose& X_CD);
  PixelLight at(const ImagerView& imager, int u, int v) const;
  /// Share of the beam that reaches p_D, 0 .. 1. The surface seen in each neighbouring pixel of the map is continued as
  /// a plane to p_D's own projection, so that no slope shades itself.
  double visible(const Eigen::Vector3d& p_D) const;

 private:
  struct Plane {
    float w = 0, w_u = 0, w_v = 0;  // 1/z and its slope over the image: linear on a plane
  };
  double unblocked(int u, int v, const Eigen::Vector2d& at, double w) const;

  PinholeCamera device_;
  Pose X_DC_;
  Eigen::Vector3d p_CD_;
  std::vector<Plane> planes_;
};

/// A device that stands at X_CD and covers what `camera` sees between z_near and z_far, with the focal length f (px);
/// never wider than `half_x`, `half_y` (tangents of half its field of view).
PinholeCamera covering_device(const PinholeCamera& camera, const Pose& X_CD, double f, const Eigen::Vector2d& z_range,
                              const Eigen::Vector2d& half);

}  // namespace binpick

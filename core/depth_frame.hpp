// What a depth camera delivers: intrinsics, depth, and where the cell believes the camera stood.
#pragma once

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/pose.hpp"

namespace binpick {

/// The noise that the camera's data sheet states: sigma_z = constant + linear z + quadratic z^2 (m). A perception
/// library may scale its tolerances by it; it is never the noise that was drawn.
struct StatedNoise {
  double constant = 0;        ///< m
  double linear = 0;          ///< m per m
  double quadratic = 0;       ///< m per m^2; stereo: s / (f B)
  double fattening_px = 0;    ///< how far foreground grows over its true outline, in pixels
  double focal_baseline = 0;  ///< m px, f B of two rectified imagers: disparity = this / z; 0: depth is made otherwise

  double sigma(double z) const { return constant + linear * z + quadratic * z * z; }
};

struct DepthFrame {
  PinholeCamera camera;
  Image<float> depth;  ///< z of C in metres, never range; NaN = no return
  Pose X_WC = Pose::Identity();  ///< as the cell BELIEVES it (forward kinematics x calibrated X_FC)
  StatedNoise noise;
};

}  // namespace binpick

// The depth cameras that presets are named after: intrinsics, baseline, range and noise of each, in one place
// (physical_models A2). The models take what they need of a row; what each value rests on is said in `source`:
// [S] seen in a source, [D] derived from such values, [R] recalled from the literature and not checked again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/camera.hpp"

namespace binpick {

struct DepthCamera {
  std::string name;           ///< as presets spell it
  PinholeCamera camera;       ///< principal point in the middle of the image
  double baseline;            ///< m, between the imagers, or between projector and camera; 0: no triangulation
  double z_min, z_max;        ///< m
  double subpixel_noise;      ///< px, RMS disparity error s; 0: the row states no s
  double projector_baseline;  ///< m, pattern projector at +x of the camera; 0: not stated
  double projector_field;     ///< rad, horizontal field of view of the projector; 0: not stated
  std::string source;

  double fB() const { return camera.fx * baseline; }  ///< m px; z = f B / d
};

const std::vector<DepthCamera>& camera_table();

/// The row of that name. A name that is not in the table is our bug (BP_CHECK).
const DepthCamera& depth_camera(std::string_view name);

}  // namespace binpick

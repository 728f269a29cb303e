// What a trial calls: look at the scene and get what the cell sees and, kept apart, what was true.
#pragma once

#include <vector>

#include "core/depth_frame.hpp"
#include "core/random.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/sensor_model.hpp"
#include "sim/visibility.hpp"

namespace binpick {

struct Capture {
  DepthFrame frame;                    ///< with the sensor's noise; frame.X_WC as believed
  ExactFrame exact;                    ///< truth
  std::vector<Visibility> visibility;  ///< truth, by part id
};

/// Where the camera stands, which unit it is, and which frame this is.
struct CaptureRequest {
  PinholeCamera camera;
  Pose X_WC_true = Pose::Identity();      ///< places the camera
  Pose X_WC_believed = Pose::Identity();  ///< what the frame says
  Seed camera_seed, frame_seed;
  int threads = 1;  ///< that the frame may use; its bits do not depend on it
};

/// Part ids 0 .. parts-1 are looked for.
Capture capture_depth(DepthRenderer& renderer, const SensorModel& sensor, const RenderScene& scene, std::size_t parts,
                      const CaptureRequest& request);

/// `parts` part ids (0 .. parts-1) are looked for. X_WC_true places the camera, X_WC_believed is what the frame says.
Capture capture_depth(DepthRenderer& renderer, const SensorModel& sensor, const RenderScene& scene, std::size_t parts,
                      const PinholeCamera& camera, const Pose& X_WC_true, const Pose& X_WC_believed, Seed camera_seed,
                      Seed frame_seed);

/// Hash of a frame's depth bits (NaN = one value) and intrinsics.
std::uint64_t frame_hash(const DepthFrame& frame);

}  // namespace binpick

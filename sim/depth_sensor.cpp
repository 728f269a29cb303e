#include "sim/depth_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/hash.hpp"

namespace binpick {

Capture capture_depth(DepthRenderer& renderer, const SensorModel& sensor, const RenderScene& scene, std::size_t parts,
                      const CaptureRequest& request) {
  BP_CHECK(is_rigid(request.X_WC_true) && is_rigid(request.X_WC_believed));
  // Things nearer than the sensor's range still hide what is behind them: near lies well before z_min.
  const double near = std::min(std::max(0.1 * sensor.z_min(), 0.02), sensor.z_min());
  const double far = 1.2 * sensor.z_max();
  const PinholeCamera& camera = request.camera;
  Capture capture;
  capture.exact = renderer.render(scene, camera, request.X_WC_true, near, far);
  capture.visibility =
      part_visibility(renderer, scene, capture.exact, camera, request.X_WC_true, parts, request.threads);
  capture.frame.camera = camera;
  capture.frame.X_WC = request.X_WC_believed;
  capture.frame.noise = sensor.stated_noise(camera);
  const auto from_device = [&](const PinholeCamera& device, const Pose& X_CD, double device_near, double device_far) {
    return renderer.render(scene, device, request.X_WC_true * X_CD, device_near, device_far);
  };
  capture.frame.depth = sensor.capture(SensorView{capture.exact, camera, from_device, request.threads},
                                       request.camera_seed, request.frame_seed);
  return capture;
}

Capture capture_depth(DepthRenderer& renderer, const SensorModel& sensor, const RenderScene& scene, std::size_t parts,
                      const PinholeCamera& camera, const Pose& X_WC_true, const Pose& X_WC_believed, Seed camera_seed,
                      Seed frame_seed) {
  return capture_depth(renderer, sensor, scene, parts,
                       CaptureRequest{camera, X_WC_true, X_WC_believed, camera_seed, frame_seed, 1});
}

std::uint64_t frame_hash(const DepthFrame& frame) {
  const PinholeCamera& c = frame.camera;
  Hasher hasher;
  hasher.add(std::uint64_t(c.width)).add(std::uint64_t(c.height)).add(c.fx).add(c.fy).add(c.cx).add(c.cy);
  for (const float z : frame.depth) hasher.add(std::isnan(z) ? -1.0 : static_cast<double>(z));
  return hasher.value();
}

}  // namespace binpick

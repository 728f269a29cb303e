// The interface of the sensor models: exact frame -> what the camera would have delivered. One .cpp file a model in
// sim/sensors/, one line in sim/sensors/registry.cpp; the model object is its own configuration (visit), so a scene
// chooses it with `sensor: {type: disparity, preset: d435_848}`.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/depth_frame.hpp"
#include "core/random.hpp"
#include "sim/depth_renderer.hpp"

namespace binpick {

/// What a model may look at. `exact` is the frame of its camera; a model with a second imager or a projector draws the
/// same scene from those too.
struct SensorView {
  const ExactFrame& exact;
  const PinholeCamera& camera;
  /// The scene from a device that stands at X_CD, between near and far (m) of that device; empty where a test has no
  /// scene.
  std::function<ExactFrame(const PinholeCamera& device, const Pose& X_CD, double near, double far)> from_device;
  int threads = 1;  ///< a model may use as many; its result does not depend on the number
};

class SensorModel {
 public:
  virtual ~SensorModel() = default;
  virtual void visit(ConfigVisitor& v) = 0;  ///< its parameters
  virtual void validate() const = 0;         ///< throws SpecError
  /// What `preset:` may say; empty for a model without presets.
  virtual std::vector<std::string> presets() const { return {}; }
  /// The intrinsics of its preset, used when the scene's camera gives none.
  virtual PinholeCamera default_camera() const = 0;
  /// Depth range in m that the model delivers; the renderer's near and far planes follow it.
  virtual double z_min() const = 0;
  virtual double z_max() const = 0;
  /// The noise its data sheet states, seen through the intrinsics that are in use (stereo: s / (f B)).
  virtual StatedNoise stated_noise(const PinholeCamera& camera) const = 0;
  /// `camera_seed` fixes what stays with the unit (bias, the fixed share of the noise), `frame_seed` what changes.
  /// Depth lies on the sensor's own grid, NaN = no return, and no value depends on the order of pixels.
  virtual Image<float> capture(const SensorView& view, Seed camera_seed, Seed frame_seed) const = 0;
  /// The same from an exact frame alone, for models that need no other view.
  Image<float> capture(const ExactFrame& exact, const PinholeCamera& camera, Seed camera_seed, Seed frame_seed) const {
    return capture(SensorView{exact, camera, {}, 1}, camera_seed, frame_seed);
  }
};

/// One row of the table of sensor models.
struct SensorEntry {
  std::string name;
  std::string help;
  std::unique_ptr<SensorModel> (*make)();
};
const std::vector<SensorEntry>& sensor_registry();
std::vector<std::string> sensor_names();
std::unique_ptr<SensorModel> make_sensor(const std::string& name);  ///< throws SpecError with the nearest name

}  // namespace binpick

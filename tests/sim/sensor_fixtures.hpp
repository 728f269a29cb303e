// Exact frames known on paper, and sensors configured by text, for the sensor tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/yaml.hpp"
#include "sim/sensor_model.hpp"

namespace binpick::test {

/// A camera that sees only `width` x `height` pixels around the optical axis of `camera`: the same f, less work.
inline PinholeCamera cropped(PinholeCamera camera, int width, int height) {
  camera.width = width;
  camera.height = height;
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

inline ExactFrame nothing(const PinholeCamera& camera) {
  const int w = camera.width, h = camera.height;
  return {Image<float>(w, h, std::numeric_limits<float>::quiet_NaN()), Image<std::int32_t>(w, h, kIdNothing),
          Image<Eigen::Vector3f>(w, h, Eigen::Vector3f::Zero()), {}};
}

/// Draws the plane through (0, 0, z) whose normal leans by `tilt` about y, in columns u0 <= u < u1, over what is there.
inline void add_wall(ExactFrame& frame, const PinholeCamera& camera, double z, double tilt = 0, int u0 = 0,
                     int u1 = 1 << 20) {
  const Eigen::Vector3d n(std::sin(tilt), 0, -std::cos(tilt));
  for (int v = 0; v < camera.height; ++v)
    for (int u = std::max(u0, 0); u < std::min(u1, camera.width); ++u) {
      frame.depth(u, v) = static_cast<float>(n.z() * z / n.dot(camera.ray(u, v)));
      frame.ids(u, v) = 0;
      frame.normals_C(u, v) = n.cast<float>();
    }
}

inline ExactFrame wall(const PinholeCamera& camera, double z, double tilt = 0) {
  ExactFrame frame = nothing(camera);
  add_wall(frame, camera, z, tilt);
  return frame;
}

/// A sensor with the keys of `yaml` set, then those of `more` over them.
inline std::unique_ptr<SensorModel> sensor(const std::string& type, const std::string& yaml,
                                           const std::string& more = "") {
  auto model = make_sensor(type);
  for (const std::string& text : {yaml, more})
    if (!text.empty()) read_yaml_text(text, "test.yaml", "", [&](ConfigVisitor& v) { model->visit(v); });
  model->validate();
  return model;
}

/// A disparity sensor with every term off but those that `more` turns on.
inline std::unique_ptr<SensorModel> bare_disparity(const std::string& preset, const std::string& more) {
  return sensor("disparity",
                "preset: " + preset +
                    "\nsubpixel_noise: 0\nincidence_gain: 0\nbias_sigma: 0\nripple: 0\nlateral_jitter: 0\n"
                    "fattening: 0\nmixed_share: 0\nspeckle: 0\nocclusion: false\ngrazing_angle: 3\n"
                    "grazing_width: 0.001\nreturn_low: 0\nmedian: false\n",
                more);
}

inline bool same_bits(const Image<float>& a, const Image<float>& b) {
  if (a.width() != b.width() || a.height() != b.height()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
  return true;
}

inline double fill(const Image<float>& depth) {
  std::size_t valid = 0;
  for (const float z : depth) valid += !std::isnan(z);
  return static_cast<double>(valid) / static_cast<double>(depth.size());
}

}  // namespace binpick::test

// Rendered scenes for the sensors that look from several devices.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "core/primitive.hpp"
#include "sensor_fixtures.hpp"
#include "sim/depth_quality.hpp"
#include "sim/depth_renderer.hpp"

namespace binpick::test {

inline Pose place(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}

/// A box whose nearest face, seen from C, is the rectangle x0 .. x1, y0 .. y1 at depth z.
inline RenderItem plate(double z, const Eigen::Vector2d& x, const Eigen::Vector2d& y, std::int32_t id,
                        const Material& material) {
  const double thick = 0.01;
  const Eigen::Vector3d size(x[1] - x[0], y[1] - y[0], thick);
  return {std::make_shared<const TriangleMesh>(mesh_of(Primitive::box(size))),
          place(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), z + 0.5 * thick), id, material};
}

inline RenderItem wide_wall(double z, const Material& material = {0.6, 0, 0.3}) {
  return plate(z, {-3, 3}, {-3, 3}, kIdTable, material);
}

struct Shot {
  ExactFrame exact;
  Image<float> depth;
};

/// One renderer, any sensor, any scene; C is the world.
class Studio {
 public:
  Shot shoot(const SensorModel& sensor, const RenderScene& scene, const PinholeCamera& camera, int threads = 1,
             Seed camera_seed = Seed{1}, Seed frame_seed = Seed{2}) {
    const auto from_device = [&](const PinholeCamera& device, const Pose& X_CD, double near, double far) {
      return renderer_->render(scene, device, X_CD, near, far);
    };
    Shot shot;
    shot.exact = renderer_->render(scene, camera, Pose::Identity(), 0.1 * sensor.z_min(), 1.2 * sensor.z_max());
    shot.depth = sensor.capture(SensorView{shot.exact, camera, from_device, threads}, camera_seed, frame_seed);
    return shot;
  }

 private:
  std::unique_ptr<DepthRenderer> renderer_ = make_osmesa_renderer();
};

/// Share of the pixels in columns u0 .. u1-1 that have depth.
inline double fill_of(const Image<float>& depth, int u0, int u1) {
  return fill_rate(depth, {u0, 0, u1, depth.height()});
}

/// Mean number of pixels without depth in a row, between columns u0 and u1.
inline double hole_width(const Image<float>& depth, int u0, int u1) { return (1 - fill_of(depth, u0, u1)) * (u1 - u0); }

}  // namespace binpick::test

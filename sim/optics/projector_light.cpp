#include "sim/optics/projector_light.hpp"

#include <algorithm>
#include <cmath>

#include "sim/optics/reflectance.hpp"

namespace binpick {
namespace {

constexpr double kShadowTolerance = 0.002;  // of the depth: 1.2 mm at 0.6 m
constexpr double kLargestStretch = 0.03;    // of the depth that a plane may be continued over a pixel

}  // namespace

ProjectorLight::ProjectorLight(const ExactFrame& map, const PinholeCamera& device, const Pose& X_CD)
    : device_(device), X_DC_(X_CD.inverse()), p_CD_(X_CD.translation()), planes_(map.depth.size()) {
  for (int v = 0; v < device.height; ++v)
    for (int u = 0; u < device.width; ++u) {
      const double z = map.depth(u, v);
      if (!(z > 0)) continue;
      // Plane n . p = c seen along ray r: 1/z = n . r / c, and c = z n . r at the pixel itself.
      const Eigen::Vector3d n = map.normals_C(u, v).cast<double>();
      const double c = z * n.dot(device.ray(u, v));
      Plane& plane = planes_[static_cast<std::size_t>(v) * device.width + u];
      plane.w = static_cast<float>(1 / z);
      if (std::abs(c) < 1e-9) continue;
      plane.w_u = static_cast<float>(n.x() / device.fx / c);
      plane.w_v = static_cast<float>(n.y() / device.fy / c);
    }
}

double ProjectorLight::unblocked(int u, int v, const Eigen::Vector2d& at, double w) const {
  if (u < 0 || v < 0 || u >= device_.width || v >= device_.height) return 1;
  const Plane& plane = planes_[static_cast<std::size_t>(v) * device_.width + u];
  const double stretch = (at.x() - u) * plane.w_u + (at.y() - v) * plane.w_v;
  const double limit = kLargestStretch * plane.w;
  return w >= plane.w + std::clamp(stretch, -limit, limit) - kShadowTolerance * w;
}

double ProjectorLight::visible(const Eigen::Vector3d& p_D) const {
  const Eigen::Vector2d at = device_.project(p_D);
  const int u = static_cast<int>(std::floor(at.x())), v = static_cast<int>(std::floor(at.y()));
  const double a = at.x() - u, b = at.y() - v, w = 1 / p_D.z();
  return (1 - b) * ((1 - a) * unblocked(u, v, at, w) + a * unblocked(u + 1, v, at, w)) +
         b * ((1 - a) * unblocked(u, v + 1, at, w) + a * unblocked(u + 1, v + 1, at, w));
}

PixelLight ProjectorLight::at(const ImagerView& imager, int u, int v) const {
  PixelLight light;
  const double z = imager.frame.depth(u, v);
  if (!(z > 0)) return light;
  const Material& material = imager.frame.materials[imager.frame.ids(u, v)];
  light.ambient = ambient_reflectance(material);
  const Eigen::Vector3d p_I = imager.camera.unproject(u, v, z);
  const Eigen::Vector3d p_C = imager.X_CI * p_I, p_D = X_DC_ * p_C;
  if (p_D.z() < 1e-3) return light;
  light.pixel_D = device_.project(p_D);
  if (!(light.pixel_D.x() > -0.5 && light.pixel_D.x() < device_.width - 0.5 && light.pixel_D.y() > -0.5 &&
        light.pixel_D.y() < device_.height - 0.5))
    return light;  // outside the pattern
  const Eigen::Vector3d n_C = imager.X_CI.linear() * imager.frame.normals_C(u, v).cast<double>();
  const Eigen::Vector3d to_light = p_CD_ - p_C, to_eye = imager.X_CI.linear() * -p_I;
  const double r2 = to_light.squaredNorm();
  light.beam = reflectance(material, n_C, to_light / std::sqrt(r2), to_eye.normalized()) / r2;
  if (light.beam > 0) light.beam *= visible(p_D);
  return light;
}

PinholeCamera covering_device(const PinholeCamera& camera, const Pose& X_CD, double f, const Eigen::Vector2d& z_range,
                              const Eigen::Vector2d& half) {
  Eigen::Array2d low = half.array(), high = -half.array();
  for (const double z : {z_range[0], z_range[1]})
    for (const double u : {-0.5, camera.width - 0.5})
      for (const double v : {-0.5, camera.height - 0.5}) {
        const Eigen::Vector3d p_D = X_CD.inverse() * camera.unproject(u, v, z);
        low = low.min(p_D.head<2>().array() / p_D.z());
        high = high.max(p_D.head<2>().array() / p_D.z());
      }
  low = low.max(-half.array());
  high = high.min(half.array());
  PinholeCamera device;
  device.fx = device.fy = f;
  device.width = std::max(16, static_cast<int>(std::ceil((high - low).x() * f)) + 2);
  device.height = std::max(16, static_cast<int>(std::ceil((high - low).y() * f)) + 2);
  device.cx = -low.x() * f + 0.5;
  device.cy = -low.y() * f + 0.5;
  return device;
}

}  // namespace binpick

#include "perception/icp_points.hpp"

#include <algorithm>

namespace binpick {

IcpPoints::IcpPoints(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, double reach, int most) {
  const Eigen::Vector3d center = X_CP * model.center().cast<double>();
  const double radius = model.radius() + reach;
  if (!(center.z() > radius)) return;
  const double near = center.z() - radius;
  const Eigen::Vector2d c = scene.camera.project(center);
  const double du = scene.camera.fx * radius / near, dv = scene.camera.fy * radius / near;
  const int u0 = std::max(0, static_cast<int>(std::max(c.x() - du, 0.0)));
  const int v0 = std::max(0, static_cast<int>(std::max(c.y() - dv, 0.0)));
  const int u1 = static_cast<int>(std::min(c.x() + du, scene.depth.width() - 1.0));
  const int v1 = static_cast<int>(std::min(c.y() + dv, scene.depth.height() - 1.0));
  // Seldom more than half of the box about the sphere is the part.
  const double area = std::max(0, u1 - u0) * std::max(0.0, static_cast<double>(v1 - v0)) / 2;
  step_ = std::max(1, static_cast<int>(std::sqrt(area / most)));
  const Eigen::Vector3f middle = center.cast<float>();
  const auto limit = static_cast<float>(radius * radius);
  for (int v = v0; v <= v1; v += step_)
    for (int u = u0; u <= u1; u += step_) {
      if (!scene.wanted(u, v)) continue;
      const Eigen::Vector3f p = scene.point(u, v, scene.depth(u, v));
      if ((p - middle).squaredNorm() < limit) add(p, scene.normals(u, v));
    }
  const Eigen::Vector3f none = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  while (numbers_[0].size() % 8 != 0) add(none, none);
}

void IcpPoints::add(const Eigen::Vector3f& p, const Eigen::Vector3f& n) {
  for (int k = 0; k < 3; ++k) {
    numbers_[k].push_back(p[k]);
    numbers_[k + 3].push_back(n[k]);
  }
}

ScenePointsView IcpPoints::view() const {
  return {numbers_[0].data(),
          numbers_[1].data(),
          numbers_[2].data(),
          numbers_[3].data(),
          numbers_[4].data(),
          numbers_[5].data(),
          static_cast<int>(numbers_[0].size())};
}

}  // namespace binpick

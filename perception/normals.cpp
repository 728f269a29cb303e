#include "perception/normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core/error.hpp"

namespace binpick {
namespace {

constexpr int kFewest = 6;    // neighbours for a plane
constexpr int kLargest = 12;  // px, half window: bounds the time on very fine images

/// Sums of eq. 1 and 2 over the window about a pixel, without the far side of a depth jump.
struct WindowSums {
  int count = 0;
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
};

WindowSums window_sums(const Scene& scene, int u, int v, const NormalsConfig& config) {
  const float z = scene.depth(u, v);
  const Eigen::Vector3f p0 = scene.point(u, v, z);
  const float radius = static_cast<float>(config.radius), jump = radius + 2 * scene.sigma(z);
  const int half = std::clamp(static_cast<int>(radius / scene.pixel(z) + 0.5f), 2, kLargest);
  const int step = half > 6 ? 2 : 1;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  int n = 0;
  for (int b = std::max(0, v - half); b <= std::min(scene.depth.height() - 1, v + half); b += step)
    for (int a = std::max(0, u - half); a <= std::min(scene.depth.width() - 1, u + half); a += step) {
      const float w = scene.depth(a, b);
      if (!(std::abs(w - z) < jump)) continue;  // false for NaN too
      const Eigen::Vector3f d = scene.point(a, b, w) - p0;
      sum += d;
      xx += d.x() * d.x(), xy += d.x() * d.y(), xz += d.x() * d.z();
      yy += d.y() * d.y(), yz += d.y() * d.z(), zz += d.z() * d.z();
      ++n;
    }
  WindowSums out;
  out.count = n;
  if (n < kFewest) return out;
  const float inverse = 1.0f / static_cast<float>(n);
  out.mean = sum * inverse;  // paper eq. 1, relative to the pixel's own point
  out.covariance << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  out.covariance = out.covariance * inverse - out.mean * out.mean.transpose();  // paper eq. 2
  return out;
}

}  // namespace

void NormalsConfig::visit(ConfigVisitor& v) {
  v.field("radius", radius, Unit::kLength, "neighbourhood of the plane fit");
  v.field("agreement", agreement, Unit::kAngle,
          "largest angle between a normal and the mean of its neighbours' (eq. 3)");
}

void NormalsConfig::validate() const {
  if (!(radius > 0 && radius < 0.1)) throw SpecError("normals.radius: must lie between 0 and 100 mm");
  if (!(agreement > 0 && agreement <= 3.2)) throw SpecError("normals.agreement: must lie between 0 and pi");
}

void estimate_normals(Scene& scene, const NormalsConfig& config) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u) {
      scene.normals(u, v).setZero();
      if (!scene.wanted(u, v)) continue;
      const WindowSums sums = window_sums(scene, u, v, config);
      if (sums.count < kFewest) continue;
      // Scaled to about one: the closed-form solver's thresholds are absolute.
      solver.computeDirect(sums.covariance / (sums.covariance.trace() + 1e-20f));
      Eigen::Vector3f n = solver.eigenvectors().col(0);
      if (!n.allFinite() || n.squaredNorm() < 0.5f) continue;
      if (n.dot(scene.point(u, v, scene.depth(u, v))) > 0) n = -n;
      scene.normals(u, v) = n.normalized();
    }
  drop_disagreeing_normals(scene, config);
}

void drop_disagreeing_normals(Scene& scene, const NormalsConfig& config) {
  const float least = static_cast<float>(std::cos(config.agreement));
  std::vector<std::size_t> dropped;
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u) {
      const Eigen::Vector3f& n = scene.normals(u, v);
      if (!scene.wanted(u, v) || n.isZero()) continue;
      const float z = scene.depth(u, v), jump = static_cast<float>(config.radius) + 2 * scene.sigma(z);
      const int reach = std::clamp(static_cast<int>(0.5 * config.radius / scene.pixel(z) + 0.5), 1, kLargest / 2);
      Eigen::Vector3f mean = Eigen::Vector3f::Zero();
      for (int b = -1; b <= 1; ++b)
        for (int a = -1; a <= 1; ++a) {
          const int x = u + a * reach, y = v + b * reach;
          if ((a == 0 && b == 0) || !scene.depth.contains(x, y)) continue;
          if (std::abs(scene.depth(x, y) - z) < jump) mean += scene.normals(x, y);
        }
      if (mean.squaredNorm() > 0 && n.dot(mean.normalized()) < least)  // paper eq. 3
        dropped.push_back(static_cast<std::size_t>(v) * scene.depth.width() + u);
    }
  for (const std::size_t i : dropped) scene.normals[i].setZero();
}

}  // namespace binpick

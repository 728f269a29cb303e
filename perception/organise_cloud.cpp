#include "perception/organise_cloud.hpp"

#include <algorithm>
#include <vector>

namespace binpick {
namespace {

constexpr double kCoarser = 1.15;     // pixel / spacing of the points: few holes, few collisions
constexpr double kWidestSlope = 2.5;  // x/z beyond which points are left out (68 degrees)
constexpr double kAround = 0.01;      // m about the bin that are kept
constexpr int kLargestImage = 2048;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Points in front of the camera and, where the bin is known, about it (pass-through, paper 3.1; the floor stays).
PointCloud in_front(const PointCloud& cloud_C, const Scene& scene) {
  PointCloud out;
  const Pose X_BC = scene.X_CB.inverse();
  for (std::size_t i = 0; i < cloud_C.size(); ++i) {
    const Eigen::Vector3d& p = cloud_C.points[i];
    if (scene.bin && ((X_BC * p).head<2>().array().abs() > scene.bin->rim_size().head<2>().array() / 2 + kAround).any())
      continue;
    if (!p.allFinite() || !(p.z() > 1e-3) || p.head<2>().cwiseAbs().maxCoeff() > kWidestSlope * p.z()) continue;
    out.points.push_back(p);
    if (cloud_C.has_normals()) out.normals.push_back(cloud_C.normals[i]);
  }
  return out;
}

PinholeCamera camera_for(const PointCloud& cloud_C) {
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  std::vector<double> depths;
  for (const Eigen::Vector3d& p : cloud_C.points) {
    const Eigen::Array2d slope = p.head<2>().array() / p.z();
    low = low.min(slope);
    high = high.max(slope);
    depths.push_back(p.z());
  }
  std::nth_element(depths.begin(), depths.begin() + depths.size() / 2, depths.end());
  const double spacing = std::max(median_spacing(cloud_C), 1e-5);
  const double widest = std::max((high - low).maxCoeff(), 1e-3);
  const double f = std::min(depths[depths.size() / 2] / (kCoarser * spacing), (kLargestImage - 2) / widest);
  PinholeCamera camera;
  camera.fx = camera.fy = f;
  camera.cx = 1 - low.x() * f;
  camera.cy = 1 - low.y() * f;
  camera.width = static_cast<int>((high.x() - low.x()) * f) + 3;
  camera.height = static_cast<int>((high.y() - low.y()) * f) + 3;
  return camera;
}

/// The pixel of a point; outside the image: its size.
std::size_t pixel_of(const Scene& scene, const Eigen::Vector3d& p) {
  const Eigen::Vector2d pixel = scene.camera.project(p);
  const int u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
  if (!scene.depth.contains(u, v)) return scene.depth.size();
  return static_cast<std::size_t>(v) * scene.depth.width() + u;
}

/// Each pixel takes its nearest point, or the mean of those no farther behind it than three standard deviations: the
/// nearest alone of several noisy ones would stand too near.
void draw(const PointCloud& cloud, Scene& scene) {
  Image<float> nearest = scene.depth;
  for (const Eigen::Vector3d& p : cloud.points) {
    const std::size_t i = pixel_of(scene, p);
    if (i < nearest.size() && !(nearest[i] <= p.z())) nearest[i] = static_cast<float>(p.z());
  }
  std::vector<int> count(nearest.size(), 0);
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const std::size_t i = pixel_of(scene, cloud.points[k]);
    const auto z = static_cast<float>(cloud.points[k].z());
    if (i == nearest.size() || z > nearest[i] + 3 * scene.sigma(nearest[i])) continue;
    Eigen::Vector3f n = cloud.normals[k].cast<float>();
    if (n.dot(cloud.points[k].cast<float>()) > 0) n = -n;
    const float weight = 1.0f / static_cast<float>(++count[i]);
    scene.depth[i] = count[i] == 1 ? z : scene.depth[i] + weight * (z - scene.depth[i]);
    scene.normals[i] += weight * (n - scene.normals[i]);
  }
  for (Eigen::Vector3f& n : scene.normals)
    n = n.norm() > 0.1f ? Eigen::Vector3f(n.normalized()) : Eigen::Vector3f::Zero();
}

}  // namespace

void organise_cloud(const PointCloud& cloud_C, const NormalsConfig& config, Scene& scene) {
  PointCloud cloud = in_front(cloud_C, scene);
  if (cloud.points.empty()) {
    scene.depth = Image<float>(16, 16, kUnknown);
    scene.normals = Image<Eigen::Vector3f>(16, 16, Eigen::Vector3f::Zero());
    return;
  }
  if (!cloud.has_normals()) cloud.normals = cloud_normals(cloud, config.radius);
  scene.camera = camera_for(cloud);
  scene.depth = Image<float>(scene.camera.width, scene.camera.height, kUnknown);
  scene.normals = Image<Eigen::Vector3f>(scene.camera.width, scene.camera.height, Eigen::Vector3f::Zero());
  draw(cloud, scene);
}

}  // namespace binpick

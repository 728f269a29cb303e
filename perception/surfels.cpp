#include "perception/surfels.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace binpick {
namespace {

constexpr int kLeastBlock = 6, kMostBlock = 40;  // px
constexpr int kSamples = 9;                      // rows and columns of a block that are looked at, at most
constexpr double kFilled = 0.35;                 // of those: walls seen obliquely have holes
constexpr double kRough = 2.5;                   // standard deviations of the noise, RMS about the plane
constexpr double kLeastRough = 0.0006;           // m, at a patch seen squarely

double median_depth(const Scene& scene) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < scene.depth.size(); i += 37)
    if (scene.depth[i] > 0) depths.push_back(scene.depth[i]);
  if (depths.empty()) return 0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

/// Least squares of 1/z = a + b du + c dv over a block.
struct InverseDepthPlane {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d y = Eigen::Vector3d::Zero();
  double yy = 0;
  int count = 0;

  void add(double du, double dv, double inverse) {
    const Eigen::Vector3d row(1, du, dv);
    A.noalias() += row * row.transpose();
    y += inverse * row;
    yy += inverse * inverse;
    ++count;
  }
};

/// The patch of a block about a pixel; false when the block is not flat.
bool patch_of(const Scene& scene, const InverseDepthPlane& sums, double u, double v, Surfel& out) {
  const Eigen::Vector3d x = sums.A.ldlt().solve(sums.y);
  if (!(x[0] > 0)) return false;
  const double z = 1 / x[0];
  const double rms = std::sqrt(std::max(0.0, sums.yy - sums.y.dot(x)) / sums.count) * z * z;
  const PinholeCamera& c = scene.camera;
  // 1/z = A + B X + C Y with the slopes X, Y of the rays is the plane (B, C, A) . p = 1.
  const Eigen::Vector3d plane(x[1] * c.fx, x[2] * c.fy, x[0] + x[1] * (c.cx - u) + x[2] * (c.cy - v));
  const Eigen::Vector3d ray = c.ray(u, v);
  out.p = z * ray;
  out.n = -plane.normalized();
  const double facing = std::max(0.15, -out.n.dot(ray.normalized()));
  return rms * facing < std::max(kLeastRough, kRough * scene.sigma(static_cast<float>(z)) * facing);
}

}  // namespace

std::vector<Surfel> surfels_of(const Scene& scene, double size) {
  const double typical = median_depth(scene);
  if (!(typical > 0)) return {};
  const int block =
      std::clamp(static_cast<int>(std::lround(size * scene.camera.fx / typical)), kLeastBlock, kMostBlock);
  const int step = (block + kSamples - 1) / kSamples, per_side = (block + step - 1) / step;
  std::vector<Surfel> out;
  for (int v0 = 0; v0 + block <= scene.depth.height(); v0 += block)
    for (int u0 = 0; u0 + block <= scene.depth.width(); u0 += block) {
      const double u = u0 + 0.5 * (block - 1), v = v0 + 0.5 * (block - 1);
      InverseDepthPlane sums;
      for (int b = 0; b < block; b += step)
        for (int a = 0; a < block; a += step)
          if (const float z = scene.depth(u0 + a, v0 + b); z > 0) sums.add(u0 + a - u, v0 + b - v, 1.0 / z);
      Surfel surfel;
      if (sums.count >= kFilled * per_side * per_side && patch_of(scene, sums, u, v, surfel)) out.push_back(surfel);
    }
  return out;
}

}  // namespace binpick

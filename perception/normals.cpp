#include "perception/normals.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "perception/normal_kernel.hpp"

namespace binpick {
namespace {

constexpr int kRows = 16;  // a piece of work; its planes stay in the cache

/// Depth and inverse depth of some rows, with unknown depth all around.
class PaddedPlanes {
 public:
  PaddedPlanes(const Image<float>& depth, int first, int count)
      : pitch_(depth.width() + 2 * kNormalPad), first_(first - kNormalReach) {
    const std::size_t rows = static_cast<std::size_t>(count) + 2 * kNormalReach;
    depth_.assign(rows * static_cast<std::size_t>(pitch_), std::numeric_limits<float>::quiet_NaN());
    for (int v = std::max(0, first_); v < std::min(depth.height(), first_ + static_cast<int>(rows)); ++v)
      std::copy_n(&depth(0, v), depth.width(), depth_.data() + offset(v));
    inverse_.resize(depth_.size());
    for (std::size_t i = 0; i < depth_.size(); ++i) inverse_[i] = 1 / depth_[i];
  }
  NormalRow row(int v, const std::uint8_t* wanted, int width) const {
    return {depth_.data() + offset(v), inverse_.data() + offset(v), pitch_, wanted, v, width};
  }

 private:
  std::ptrdiff_t offset(int v) const { return (v - first_) * pitch_ + kNormalPad; }
  std::ptrdiff_t pitch_;
  int first_;
  std::vector<float> depth_, inverse_;
};

NormalRule rule_of(const Scene& scene, const NormalsConfig& config) {
  const auto f = [](double x) { return static_cast<float>(x); };
  const PinholeCamera& c = scene.camera;
  return {f(c.fx),
          f(c.fy),
          f(c.cx),
          f(c.cy),
          f(config.radius),
          f(scene.noise.constant),
          f(scene.noise.linear),
          f(scene.noise.quadratic)};
}

/// Eq. 1 and 2 for some rows.
void fit_planes(Scene& scene, const NormalsConfig& config, int first, int count) {
  const int width = scene.depth.width();
  const PaddedPlanes planes(scene.depth, first, count);
  const NormalRule rule = rule_of(scene, config);
  const std::size_t padded = static_cast<std::size_t>(width) + 16;
  std::vector<float> x(padded), y(padded), z(padded);
  std::vector<std::uint8_t> wanted(padded, 0);
  for (int v = first; v < first + count; ++v) {
    std::copy_n(&scene.wanted(0, v), width, wanted.begin());
    normals_of_row(planes.row(v, wanted.data(), width), rule, {x.data(), y.data(), z.data()});
    for (int u = 0; u < width; ++u) scene.normals(u, v) = Eigen::Vector3f(x[u], y[u], z[u]);
  }
}

/// Wanted pixels of a row whose normals disagree with their neighbourhood (eq. 3).
void disagreeing(const Scene& scene, const NormalsConfig& config, int v, std::vector<std::size_t>& out) {
  const float least = static_cast<float>(std::cos(config.agreement));
  for (int u = 0; u < scene.depth.width(); ++u) {
    if (!scene.wanted(u, v)) continue;
    const Eigen::Vector3f& n = scene.normals(u, v);
    if (n.isZero()) continue;
    const float z = scene.depth(u, v), jump = static_cast<float>(config.radius) + 2 * scene.sigma(z);
    const int reach = std::clamp(static_cast<int>(0.5f * static_cast<float>(config.radius) / scene.pixel(z) + 0.5f), 1,
                                 kNormalReach / 2);
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (int b = -1; b <= 1; ++b)
      for (int a = -1; a <= 1; ++a) {
        const int x = u + a * reach, y = v + b * reach;
        if ((a == 0 && b == 0) || !scene.depth.contains(x, y)) continue;
        if (std::abs(scene.depth(x, y) - z) < jump) mean += scene.normals(x, y);
      }
    const float length = mean.norm();
    if (length > 0 && n.dot(mean) < least * length)  // paper eq. 3
      out.push_back(static_cast<std::size_t>(v) * scene.depth.width() + u);
  }
}

std::size_t pieces_of(const Scene& scene) {
  return (static_cast<std::size_t>(scene.depth.height()) + kRows - 1) / kRows;
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
  parallel_for(pieces_of(scene), scene.threads, [&](std::size_t piece) {
    const int first = static_cast<int>(piece) * kRows;
    fit_planes(scene, config, first, std::min(kRows, scene.depth.height() - first));
  });
  drop_disagreeing_normals(scene, config);
}

void drop_disagreeing_normals(Scene& scene, const NormalsConfig& config) {
  std::vector<std::vector<std::size_t>> dropped(pieces_of(scene));
  parallel_for(dropped.size(), scene.threads, [&](std::size_t piece) {
    const int first = static_cast<int>(piece) * kRows;
    for (int v = first; v < std::min(scene.depth.height(), first + kRows); ++v)
      disagreeing(scene, config, v, dropped[piece]);
  });
  for (const auto& piece : dropped)
    for (const std::size_t i : piece) scene.normals[i].setZero();
}

}  // namespace binpick

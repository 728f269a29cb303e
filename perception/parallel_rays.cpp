#include "perception/parallel_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.hpp"

namespace binpick {
namespace {

constexpr double kSlack = 1e-9;  // m: far above the rounding of any coordinate of a part
constexpr int kLeastCells = 4, kMostCells = 48;

/// A float that is not below x.
float rounded_up(double x) { return static_cast<float>(x + kSlack + 1e-7 * std::abs(x)); }

}  // namespace

ParallelRays::ParallelRays(const TriangleMesh& mesh, const Eigen::Vector3d& direction) : triangles_(mesh.triangles) {
  BP_CHECK(direction.allFinite() && !direction.isZero(0));
  direction.cwiseAbs().maxCoeff(&z_);
  x_ = (z_ + 1) % 3;
  y_ = (z_ + 2) % 3;
  if (direction[z_] < 0) std::swap(x_, y_);
  shear_x_ = direction[x_] / direction[z_];
  shear_y_ = direction[y_] / direction[z_];
  shear_z_ = 1 / direction[z_];
  sign_ = direction[z_] < 0 ? -1 : 1;
  points_.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& p : mesh.vertices) points_.emplace_back(p[x_], p[y_], p[z_]);
  fill_grid();
}

/// Permuted point -> place across the rays, and height along them.
Eigen::Vector3d ParallelRays::sheared(const Eigen::Vector3d& p) const {
  return {p.x() - shear_x_ * p.z(), p.y() - shear_y_ * p.z(), sign_ * p.z()};
}

std::array<int, 2> ParallelRays::cell_of(double x, double y) const {
  const double last = size_ - 1;
  return {static_cast<int>(std::clamp((x - low_x_) * per_x_, 0.0, last)),
          static_cast<int>(std::clamp((y - low_y_) * per_y_, 0.0, last))};
}

/// The cells that the triangle may lie over, and how far along the rays it reaches.
ParallelRays::Shade ParallelRays::shade_of(std::size_t triangle, const std::vector<Eigen::Vector3d>& across) const {
  const auto& t = triangles_[triangle];
  const Eigen::Vector3d &a = across[t[0]], &b = across[t[1]], &c = across[t[2]];
  const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  return {cell_of(low.x() - kSlack, low.y() - kSlack), cell_of(high.x() + kSlack, high.y() + kSlack),
          rounded_up(high.z())};
}

void ParallelRays::fill_grid() {
  size_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(triangles_.size()))), kLeastCells, kMostCells);
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  std::vector<Eigen::Vector3d> across;
  across.reserve(points_.size());
  for (const Eigen::Vector3d& p : points_) {
    across.push_back(sheared(p));
    low = low.min(across.back().array());
    high = high.max(across.back().array());
  }
  low_x_ = low.x(), low_y_ = low.y();
  per_x_ = size_ / std::max(high.x() - low.x(), kSlack);
  per_y_ = size_ / std::max(high.y() - low.y(), kSlack);
  std::vector<Shade> shades(triangles_.size());
  first_.assign(static_cast<std::size_t>(size_ * size_) + 1, 0);
  const auto each_cell = [&](const Shade& shade, auto&& visit) {
    for (int y = shade.low[1]; y <= shade.high[1]; ++y)
      for (int x = shade.low[0]; x <= shade.high[0]; ++x) visit(static_cast<std::size_t>(y * size_ + x));
  };
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    shades[t] = shade_of(t, across);
    each_cell(shades[t], [&](std::size_t cell) { ++first_[cell + 1]; });
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  candidates_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Candidate candidate{static_cast<std::uint32_t>(t), shades[t].top};
    each_cell(shades[t], [&](std::size_t cell) { candidates_[next[cell]++] = candidate; });
  }
}

bool ParallelRays::hits(std::uint32_t triangle, const Eigen::Vector3d& origin) const {
  const auto& t = triangles_[triangle];
  const Eigen::Vector3d a = points_[t[0]] - origin, b = points_[t[1]] - origin, c = points_[t[2]] - origin;
  const double ax = a.x() - shear_x_ * a.z(), ay = a.y() - shear_y_ * a.z();
  const double bx = b.x() - shear_x_ * b.z(), by = b.y() - shear_y_ * b.z();
  const double cx = c.x() - shear_x_ * c.z(), cy = c.y() - shear_y_ * c.z();
  const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double det = u + v + w;
  if (det == 0) return false;
  return shear_z_ * (u * a.z() + v * b.z() + w * c.z()) / det >= 0;
}

bool ParallelRays::blocked(const Eigen::Vector3d& origin) {
  const Eigen::Vector3d from(origin[x_], origin[y_], origin[z_]);
  if (last_ < triangles_.size() && hits(last_, from)) return true;
  const Eigen::Vector3d across = sheared(from);
  const auto [x, y] = cell_of(across.x(), across.y());
  const auto cell = static_cast<std::size_t>(y * size_ + x);
  for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
    if (candidates_[k].top < across.z() || !hits(candidates_[k].triangle, from)) continue;
    last_ = candidates_[k].triangle;
    return true;
  }
  return false;
}

}  // namespace binpick

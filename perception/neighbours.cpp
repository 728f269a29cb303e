#include "perception/neighbours.hpp"

#include <algorithm>

namespace binpick {
namespace {
constexpr float kMostCells = 200.0f;  // along one edge: bounds the memory when points are far apart
}

PointGrid::PointGrid(const std::vector<Eigen::Vector3f>& points, float cell) : cell_(cell) {
  first_.assign(2, 0);
  if (points.empty()) return;
  Eigen::Array3f high = points.front().array();
  low_ = high;
  for (const Eigen::Vector3f& p : points) {
    low_ = low_.min(p.array());
    high = high.max(p.array());
  }
  cell_ = std::max({cell, (high - low_).maxCoeff() / kMostCells, 1e-6f});
  size_ = ((high - low_) / cell_).floor().cast<int>() + 1;
  const auto flat = [&](const Eigen::Vector3f& p) {
    const Eigen::Vector3i c = cell_of(p.array());
    return (static_cast<std::size_t>(c.z()) * size_.y() + c.y()) * size_.x() + c.x();
  };
  first_.assign(static_cast<std::size_t>(size_.prod()) + 1, 0);
  for (const Eigen::Vector3f& p : points) ++first_[flat(p) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  points_.resize(points.size());
  index_.resize(points.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t k = next[flat(points[i])]++;
    points_[k] = points[i];
    index_[k] = static_cast<std::uint32_t>(i);
  }
}

}  // namespace binpick

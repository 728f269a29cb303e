#include "evaluation/vertex_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace binpick {
namespace {
constexpr std::size_t kLeaf = 8;  // ranges this small are scanned
}

VertexTree::VertexTree(std::vector<Eigen::Vector3d> points) : points_(std::move(points)), axis_(points_.size(), 0) {
  build(0, points_.size());
}

void VertexTree::build(std::size_t begin, std::size_t end) {
  if (end - begin <= kLeaf) return;
  Eigen::Vector3d low = points_[begin], high = points_[begin];
  for (std::size_t i = begin; i < end; ++i) {
    low = low.cwiseMin(points_[i]);
    high = high.cwiseMax(points_[i]);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
  axis_[middle] = static_cast<std::uint8_t>(axis);
  build(begin, middle);
  build(middle + 1, end);
}

void VertexTree::search(std::size_t begin, std::size_t end, const Eigen::Vector3d& query, double& best_squared) const {
  if (end - begin <= kLeaf) {
    for (std::size_t i = begin; i < end; ++i) {
      best_squared = std::min(best_squared, (points_[i] - query).squaredNorm());
    }
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  best_squared = std::min(best_squared, (points_[middle] - query).squaredNorm());
  const double beyond = query[axis_[middle]] - points_[middle][axis_[middle]];
  const bool low_first = beyond < 0;
  search(low_first ? begin : middle + 1, low_first ? middle : end, query, best_squared);
  if (beyond * beyond < best_squared) {
    search(low_first ? middle + 1 : begin, low_first ? end : middle, query, best_squared);
  }
}

double VertexTree::distance(const Eigen::Vector3d& query) const {
  double best_squared = std::numeric_limits<double>::infinity();
  search(0, points_.size(), query, best_squared);
  return std::sqrt(best_squared);
}

}  // namespace binpick

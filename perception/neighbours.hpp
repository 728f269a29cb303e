// Radius queries among points: a uniform grid with the points of a cell side by side. The order of the answers is fixed
// by the points alone. Frame: whatever the points are in; metres.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace binpick {

class PointGrid {
 public:
  /// `cell` (m): about the radius that will be asked for. Points are copied.
  PointGrid(const std::vector<Eigen::Vector3f>& points, float cell);

  /// Calls visit(index) for every point within `radius` of `center`.
  template <class Visit>
  void within(const Eigen::Vector3f& center, float radius, Visit&& visit) const {
    if (points_.empty()) return;
    const Eigen::Vector3i low = cell_of(center.array() - radius), high = cell_of(center.array() + radius);
    const float limit = radius * radius;
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y) {
        const std::size_t row = (static_cast<std::size_t>(z) * size_.y() + y) * size_.x();
        for (std::uint32_t k = first_[row + low.x()]; k < first_[row + high.x() + 1]; ++k)
          if ((points_[k] - center).squaredNorm() <= limit) visit(index_[k]);
      }
  }

 private:
  Eigen::Vector3i cell_of(const Eigen::Array3f& p) const {
    return ((p - low_) / cell_).max(0.0f).min(size_.cast<float>().array() - 1.0f).floor().cast<int>();
  }
  float cell_;
  Eigen::Array3f low_ = Eigen::Array3f::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Ones();
  std::vector<std::uint32_t> first_, index_;
  std::vector<Eigen::Vector3f> points_;
};

}  // namespace binpick

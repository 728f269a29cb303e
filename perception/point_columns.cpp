#include "perception/point_columns.hpp"

#include <cstring>

namespace binpick {
namespace {
constexpr float kMostCells = 400.0f;  // along one edge: bounds the memory when points are far apart
}  // namespace

OrientedColumns::OrientedColumns(const std::vector<OrientedPoint>& points) : OrientedColumns(points.size()) {
  for (std::size_t i = 0; i < points.size(); ++i) set(i, points[i]);
}

void OrientedColumns::resize(std::size_t size) {
  for (std::vector<float>& c : column) c.resize(size, 0.0f);
}

void OrientedColumns::set(std::size_t i, const OrientedPoint& p) {
  for (int k = 0; k < 3; ++k) {
    column[k][i] = p.point[k];
    column[k + 3][i] = p.normal[k];
  }
}

std::size_t OrientedColumns::thin(std::size_t count, std::size_t step, std::size_t turn) {
  if (step < 2) return count;
  const std::size_t from = turn % step, kept = count > from ? (count - from - 1) / step + 1 : 0;
  for (std::vector<float>& c : column)
    for (std::size_t k = 0; k < kept; ++k) c[k] = c[from + k * step];
  return kept;
}

PointColumns::PointColumns(const std::vector<OrientedPoint>& points, float cell)
    : first_(2, 0), sorted_(points.size()) {
  if (points.empty()) return;
  Eigen::Array2f low = points.front().point.head<2>(), high = low;
  for (const OrientedPoint& p : points) {
    low = low.min(p.point.head<2>().array());
    high = high.max(p.point.head<2>().array());
  }
  low_x_ = low.x(), low_y_ = low.y();
  cell_ = std::max({cell, (high - low).maxCoeff() / kMostCells, 1e-6f});
  inverse_ = 1 / cell_;
  width_ = static_cast<int>((high.x() - low.x()) * inverse_) + 1;
  height_ = static_cast<int>((high.y() - low.y()) * inverse_) + 1;
  const auto flat = [&](const OrientedPoint& p) {
    return static_cast<std::size_t>(row_of(p.point.y())) * width_ + column_of(p.point.x());
  };
  first_.assign(static_cast<std::size_t>(width_) * height_ + 1, 0);
  for (const OrientedPoint& p : points) ++first_[flat(p) + 1];
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const OrientedPoint& p : points) sorted_.set(next[flat(p)]++, p);
}

std::size_t PointColumns::gather(const Eigen::Vector3f& center, float radius, OrientedColumns& out) const {
  std::size_t count = 0;
  if (size() == 0) return count;
  for (int row = row_of(center.y() - radius), last = row_of(center.y() + radius); row <= last; ++row) {
    const float bottom = low_y_ + cell_ * static_cast<float>(row), top = bottom + cell_;
    // Rounding may put a point one ulp beside its cell: the strip is taken a little wider.
    const float dy = std::max({bottom - center.y(), center.y() - top, 0.0f}) - 1e-3f * cell_;
    const float reach = std::sqrt(std::max(radius * radius - dy * std::abs(dy), 0.0f)) + 1e-3f * cell_;
    const std::size_t line = static_cast<std::size_t>(row) * width_;
    const std::uint32_t from = first_[line + column_of(center.x() - reach)],
                        to = first_[line + column_of(center.x() + reach) + 1];
    for (std::size_t k = 0; k < 6; ++k)
      std::memcpy(out.column[k].data() + count, sorted_.column[k].data() + from, (to - from) * sizeof(float));
    count += to - from;
  }
  return count;
}

}  // namespace binpick

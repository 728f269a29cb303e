// Oriented points coordinate by coordinate, sorted into a grid over x and y. In frame C that is a grid over the image
// plane: a scene is a surface seen from there, so z needs no cells. Answers the neighbourhood of a point as columns
// that the pair kernel takes as they are. Metres.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "perception/pair_feature.hpp"

namespace binpick {

/// Six columns of equal length: points and unit normals.
struct OrientedColumns {
  std::array<std::vector<float>, 6> column;

  explicit OrientedColumns(std::size_t size = 0) { resize(size); }
  explicit OrientedColumns(const std::vector<OrientedPoint>& points);
  std::size_t size() const { return column[0].size(); }
  void resize(std::size_t size);
  void set(std::size_t i, const OrientedPoint& p);
  /// Of the first `count` points only every `step`-th stays, beginning with number turn modulo step; returns how many.
  std::size_t thin(std::size_t count, std::size_t step, std::size_t turn);
  PairColumns view() const {
    return {column[0].data(), column[1].data(), column[2].data(), column[3].data(), column[4].data(), column[5].data()};
  }
};

class PointColumns {
 public:
  /// `cell` (m): a fraction of the radius that will be asked for.
  PointColumns(const std::vector<OrientedPoint>& points, float cell);

  /// Writes every point within `radius` of `center` into the first columns of `out` (which must hold size() points),
  /// some points beyond it among them, and returns how many.
  std::size_t gather(const Eigen::Vector3f& center, float radius, OrientedColumns& out) const;
  std::size_t size() const { return sorted_.size(); }

 private:
  int column_of(float x) const { return cell_within((x - low_x_) * inverse_, width_); }
  int row_of(float y) const { return cell_within((y - low_y_) * inverse_, height_); }
  static int cell_within(float at, int size) {
    return static_cast<int>(std::clamp(at, 0.0f, static_cast<float>(size - 1)));
  }

  float low_x_ = 0, low_y_ = 0, cell_ = 1, inverse_ = 1;
  int width_ = 1, height_ = 1;
  std::vector<std::uint32_t> first_;
  OrientedColumns sorted_;
};

}  // namespace binpick

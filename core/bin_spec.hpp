// The bin: an open box. Frame B: centre of the inner floor, z up.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/primitive.hpp"

namespace binpick {

struct BinSpec {
  Eigen::Vector3d inner_size = {0.4, 0.3, 0.2};  ///< m: x, y, height of the walls
  double wall = 0.005;                           ///< m, wall and floor thickness as seen
  double friction = 0.4;
  double restitution = 0.1;

  void visit(ConfigVisitor& v) {
    v.field("inner_size", inner_size, Unit::kLength, "inner length, width and height of the walls");
    v.field("wall", wall, Unit::kLength, "thickness of walls and floor as seen (collision walls are thicker, outwards)");
    v.field("friction", friction, Unit::kNone, "Coulomb coefficient of bin against part");
    v.field("restitution", restitution, Unit::kNone, "restitution of bin against part");
  }
  void validate() const {
    if (!(inner_size.minCoeff() > 0.01) || !(inner_size.maxCoeff() < 5))
      throw SpecError("bin.inner_size: each edge must lie between 10 mm and 5 m");
    if (!(wall >= 0.001) || !(wall <= 0.1)) throw SpecError("bin.wall: must lie between 1 and 100 mm");
    if (!(friction >= 0 && friction <= 2)) throw SpecError("bin.friction: must lie between 0 and 2");
    if (!(restitution >= 0 && restitution < 1)) throw SpecError("bin.restitution: must lie between 0 and 1");
  }
};

/// Floor and four walls as boxes in B. The inner faces are exact; `thickness` goes outwards.
std::vector<Primitive> bin_boxes(const BinSpec& bin, double thickness);

}  // namespace binpick

// A grey image printed on a flat item: marker plates, labels. Lies in the plane z = 0 of the item's frame O, centred at
// its origin, seen from +z: columns run along +x, rows along -y (row 0 at the top, +y). Texels are squares of one
// reflectance with sharp edges; a look at it averages over an area, so that nothing aliases however small it appears.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/image.hpp"

namespace binpick {

class SurfaceTexture {
 public:
  /// `grey` 0 .. 255 is reflectance 0 .. 1, linear. `size` (m): of the whole image along x and y.
  SurfaceTexture(const Image<std::uint8_t>& grey, const Eigen::Vector2d& size);

  const Eigen::Vector2d& size() const { return size_; }
  /// Does a place lie on the image, or no farther beside it than `margin` (m)?
  bool covers(const Eigen::Vector2d& p_O, const Eigen::Vector2d& margin = Eigen::Vector2d::Zero()) const {
    return (p_O.array().abs() <= size_.array() / 2 + margin.array()).all();
  }
  /// Mean reflectance of the box p_O +- half (m), the image's own edge continued outwards.
  double mean(const Eigen::Vector2d& p_O, const Eigen::Vector2d& half) const;

 private:
  /// Sum of all that lies left of and above a place, in texels.
  double integral(double x, double y) const;

  int width_, height_;
  Eigen::Vector2d size_;
  std::vector<double> sums_;  ///< summed-area table, (width + 1) x (height + 1)
};

}  // namespace binpick

// The part of a pose's covariance that no look at a symmetric part can make smaller. Twists in P (translation m,
// rotation rad).
#pragma once

#include <numbers>
#include <vector>

#include "core/pose.hpp"

namespace binpick {

/// A turn that changes nothing cannot be known: uniform over a whole turn, about each of these twists (symmetry_twists).
inline Matrix6d unknowable(const std::vector<Vector6d>& twists) {
  Matrix6d out = Matrix6d::Zero();
  for (const Vector6d& twist : twists) out += std::numbers::pi * std::numbers::pi / 3 * twist * twist.transpose();
  return out;
}

}  // namespace binpick

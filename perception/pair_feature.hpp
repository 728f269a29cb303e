// The feature of an oriented point pair and its quantisation (paper 4; Drost et al., CVPR 2010):
//   F(1, 2) = (|d|, angle(n1, d), angle(n2, d), angle(n1, n2)),  d = p2 - p1.
// Lengths in metres, angles in radians in [0, pi]. The feature does not change when both points move rigidly.
// Beside it: the canonical frame of a reference point (its normal turned onto +x) and the angle alpha of its partner
// about that normal, which together with the reference point fixes a pose (paper 4.1).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "perception/pair_kernel.hpp"

namespace binpick {

struct PairFeature {
  float distance = 0;
  float angle_1 = 0;  ///< n1 to d
  float angle_2 = 0;  ///< n2 to d
  float angle_n = 0;  ///< n1 to n2
};

/// A point with its unit normal.
struct OrientedPoint {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitX();
};

using pair_math::unit_angle;

inline float dot(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return pair_math::dot(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
}

inline PairFeature pair_feature(const OrientedPoint& a, const OrientedPoint& b) {
  const Eigen::Vector3f d = b.point - a.point;
  const float length = std::sqrt(dot(d, d)), inverse = 1 / std::max(length, 1e-12f);
  return {length, unit_angle(dot(a.normal, d) * inverse), unit_angle(dot(b.normal, d) * inverse),
          unit_angle(dot(a.normal, b.normal))};
}

/// Cuts features into cells: multiples of a length and of an angle (paper 4: 5 mm and 12 degrees).
struct PairQuantiser {
  float distance_step = 0.005f;
  float angle_step = 0.2094395f;
  int distance_bins = 1;
  int angle_bins = 1;

  PairQuantiser() = default;
  PairQuantiser(double longest, double distance_step_m, double angle_step_rad)
      : distance_step(static_cast<float>(distance_step_m)), angle_step(static_cast<float>(angle_step_rad)) {
    distance_bins = static_cast<int>(std::floor(longest / distance_step_m * (1 + 1e-6))) + 1;
    // Exactly pi (opposite normals are common) belongs to the last full bin, not to a bin of its own.
    angle_bins = std::max(1, static_cast<int>(std::ceil(std::numbers::pi / angle_step_rad - 1e-3)));
  }

  int cells() const { return distance_bins * angle_bins * angle_bins * angle_bins; }
  PairSteps steps() const { return {1 / distance_step, 1 / angle_step, distance_bins, angle_bins}; }

  /// The cell, or -1 for a pair without length or longer than any of the model.
  int cell(const PairFeature& f) const {
    const PairSteps s = steps();
    const int d = static_cast<int>(f.distance * s.per_metre);
    if (!(f.distance > 0) || d >= distance_bins) return -1;
    return pair_math::cell_of(d, angle_bin(f.angle_1), angle_bin(f.angle_2), angle_bin(f.angle_n), s);
  }
  int angle_bin(float angle) const { return pair_math::angle_bin(angle, steps()); }
};

/// A rotation that turns the unit vector `normal` onto +x, chosen by a fixed rule.
inline Eigen::Matrix3f frame_with_x(const Eigen::Vector3f& normal) {
  const Eigen::Vector3f helper = std::abs(normal.z()) < 0.8f ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitY();
  const Eigen::Vector3f y = normal.cross(helper).normalized();
  Eigen::Matrix3f R;
  R.row(0) = normal;
  R.row(1) = y;
  R.row(2) = normal.cross(y);
  return R;
}

/// Angle of the partner about the reference's normal, in 1/65536 turns: sums wrap around by themselves.
inline std::uint16_t alpha_turns(const Eigen::Matrix3f& R, const Eigen::Vector3f& d) {
  return static_cast<std::uint16_t>(pair_math::turns_of(dot(R.row(1).transpose(), d), dot(R.row(2).transpose(), d)));
}

/// A reference as the wide kernel takes it.
inline PairReference pair_reference(const OrientedPoint& a) {
  const Eigen::Matrix3f R = frame_with_x(a.normal);
  PairReference out;
  for (int k = 0; k < 3; ++k) {
    out.point[k] = a.point[k];
    out.x[k] = a.normal[k], out.y[k] = R(1, k), out.z[k] = R(2, k);
  }
  return out;
}

}  // namespace binpick

// The distance of two poses of Bregier et al. (ICCV workshops 2017; IJCV 2018, arXiv 1612.04631 and 1806.08129): root
// mean square displacement of the part's surface, least over its symmetries,
//   d(X_1, X_2)^2 = min over S of (1/A) integral |X_2 S x - X_1 x|^2 dA,
// in closed form as the distance of representatives. With c the surface's centroid, M = (1/A) integral (x - c)(x - c)^T
// dA and L = M^(1/2) (symmetric; no inertial frame is needed):
//   finite group    (vec(R L), X c) against (vec(R R_k L), X S_k c) for every member
//   revolution      (lambda R a, X c), a the axis, lambda^2 = l_r^2 + l_a^2 of the moments across (each) and along it:
//                   |(R_1 - R_2 turn) L|_F^2, minimised over the turn, is lambda^2 |R_1 a - R_2 a|^2; flips as members
//   sphere          X c alone
// Metres; frame P.
#pragma once

#include <Eigen/Core>

#include "core/mesh.hpp"
#include "core/pose.hpp"
#include "core/symmetry.hpp"

namespace binpick {

class SurfaceDistance {
 public:
  /// A mesh without area (points only) counts as its vertices, all alike.
  SurfaceDistance(const TriangleMesh& mesh_P, const Symmetry& symmetry);

  double between(const Pose& X_WP_1, const Pose& X_WP_2) const;

  const Eigen::Vector3d& center_P() const { return center_P_; }
  const Eigen::Matrix3d& moment_P() const { return moment_P_; }  ///< M, m^2
  /// Diameter of the smallest ball around the vertices, to 0.1 %; a pose is right within a tenth of it.
  double ball_diameter() const { return ball_diameter_; }

 private:
  Symmetry symmetry_;
  Eigen::Vector3d center_P_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moment_P_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d root_P_ = Eigen::Matrix3d::Zero();
  double lambda_ = 0;
  double ball_diameter_ = 0;
};

}  // namespace binpick

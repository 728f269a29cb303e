// Private to robot: closed form for arms of the UR type: axes 2, 3 and 4 parallel, 1 perpendicular to them, 5 to 4, 6
// to 5, and 5 meets 6. Shoulder x wrist x elbow: up to eight solutions. Angles are measured from the zero position of
// the chain itself (product of exponentials), so that no DH table is needed.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "robot/urdf_reader.hpp"

namespace binpick {

class ParallelAxes {
 public:
  /// Empty when the axes are not those (to 1e-4 rad and m: files round their angles).
  static std::optional<ParallelAxes> find(const SerialChain& chain);

  /// Solutions of the ideal arm, limits and turns ignored; joint 6 as in q_near where the wrist is singular.
  std::vector<Vector6d> branches(const Pose& X_RF, const Vector6d& q_near) const;

 private:
  /// Turns of joints 5 and 6 and of the three parallel ones together, that give M; see branches().
  struct Wrist {
    double t5 = 0, t6 = 0, lean = 0;
  };
  std::vector<Wrist> wrists(const Eigen::Matrix3d& M, const Eigen::Vector3d& p_wrist, double t6_near) const;
  void add_elbows(double t1, const Wrist& wrist, const Eigen::Vector3d& p_wrist, std::vector<Vector6d>& out) const;

  Pose X_RO_ = Pose::Identity();                        ///< O: z along axis 1, y along axis 2, at the zero position
  Eigen::Matrix3d R_OF_ = Eigen::Matrix3d::Identity();  ///< at the zero position
  std::array<int, 6> sign_{1, 1, 1, 1, 1, 1};
  Eigen::Vector3d shoulder_, upper_, fore_, hand_;  ///< m, in O at zero: axis 1 to 2, 2 to 3, 3 to 4, 4 to the wrist
  Eigen::Vector3d u5_, u6_;                         ///< directions in O at zero
  Eigen::Vector3d p_F_wrist_;                       ///< m, where 5 meets 6, in F
};

}  // namespace binpick

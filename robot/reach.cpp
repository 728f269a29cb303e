#include "robot/reach.hpp"

#include <numbers>

#include "robot/inverse_kinematics.hpp"

namespace binpick {

bool reaches(const Cell& cell, const Eigen::Vector3d& p_W, const Eigen::Vector3d& axis_W) {
  constexpr int kTurns = 12;
  const Pose X_GF = cell.gripper->X_FG().inverse();
  const Eigen::Matrix3d R_WG = rotation_with_z(axis_W);
  for (int k = 0; k < kTurns; ++k) {
    const Eigen::AngleAxisd turn(2 * std::numbers::pi * k / kTurns, Eigen::Vector3d::UnitZ());
    const Pose X_WG = pose_from(R_WG * turn.toRotationMatrix(), p_W);
    if (has_solution(*cell.arm, cell.X_WR.inverse() * X_WG * X_GF, cell.q_home)) return true;
  }
  return false;
}

}  // namespace binpick

// Closed-form inverse kinematics of a spherical-wrist arm (OPW): every branch within the limits, nearest first.
#pragma once

#include <vector>

#include "robot/arm.hpp"

namespace binpick {

/// All solutions of forward(q) = X_RF inside the joint limits (full turns of joint 6 and 4 included where the limits
/// allow them), sorted by the largest joint motion from q_near. Empty when out of reach.
std::vector<Vector6d> inverse_kinematics(const Arm& arm, const Pose& X_RF, const Vector6d& q_near);

/// The up to eight branches of the geometry itself, limits ignored, each joint in (-pi, pi].
std::vector<Vector6d> all_branches(const Arm& arm, const Pose& X_RF);

}  // namespace binpick

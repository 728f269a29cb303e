// Inverse kinematics: every branch within the limits, nearest first. In closed form for arms with a spherical wrist
// (OPW), numeric with restarts for all others (numeric_ik).
#pragma once

#include <optional>
#include <vector>

#include "robot/arm.hpp"

namespace binpick {

/// All solutions of forward(q) = X_RF inside the joint limits (full turns included where the limits allow them), sorted
/// by the largest joint motion from q_near. Empty when out of reach.
std::vector<Vector6d> inverse_kinematics(const Arm& arm, const Pose& X_RF, const Vector6d& q_near);

/// Of every branch within the limits the turn of each joint that is nearest to q_near, sorted in the same way: where
/// joints turn twice, inverse_kinematics() has each posture in dozens of turns.
std::vector<Vector6d> nearest_postures(const Arm& arm, const Pose& X_RF, const Vector6d& q_near);

/// Is this an arm with more than four turns to every posture, as of the UR type?
bool turns_freely(const Arm& arm);

/// One step along a path: the solution that q_near leads to, if it lies within the limits. The first of
/// inverse_kinematics() for a closed form; for other arms much quicker than it, and the same branch in small steps.
std::optional<Vector6d> following_solution(const Arm& arm, const Pose& X_RF, const Vector6d& q_near);

/// Is there any solution inside the limits? Quicker than inverse_kinematics() for arms without a closed form.
bool has_solution(const Arm& arm, const Pose& X_RF, const Vector6d& q_near);

/// The branches of the geometry itself (at most eight in closed form), limits ignored, each joint in (-pi, pi].
std::vector<Vector6d> all_branches(const Arm& arm, const Pose& X_RF);

}  // namespace binpick

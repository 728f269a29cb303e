// Poses. X_AB is the pose of frame B in frame A; products cancel letters: X_WP = X_WC * X_CP. Metres and radians.
#pragma once

#include <Eigen/Geometry>

namespace binpick {

using Pose = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Pose from a position and roll, pitch, yaw (rotation Rz(yaw) Ry(pitch) Rx(roll), as in URDF and on most pendants).
Pose pose_from_xyz_rpy(const Eigen::Vector3d& p_AB, const Eigen::Vector3d& rpy);

/// Roll, pitch, yaw of a rotation; pitch lies in [-pi/2, pi/2]. At the pole roll is 0.
Eigen::Vector3d rpy_of(const Eigen::Matrix3d& R_AB);

/// The pose as a configuration file can hold it: roll, pitch, yaw on a grid of 1e-12 rad. Reading what was written
/// gives the same bits, so that a stored scenario replays exactly.
Eigen::Vector3d stored_rpy(const Eigen::Matrix3d& R_AB);
Pose stored_pose(const Pose& X_AB);

/// Pose from a rotation matrix and a position.
Pose pose_from(const Eigen::Matrix3d& R_AB, const Eigen::Vector3d& p_AB);

/// Exponential of a twist (translation first, then rotation) and its inverse; |rotation| <= pi.
Pose exp_se3(const Vector6d& twist);
Vector6d log_se3(const Pose& X_AB);

/// Rotation vector (axis times angle) of a rotation, angle in [0, pi], and its inverse.
Eigen::Vector3d log_so3(const Eigen::Matrix3d& R_AB);
Eigen::Matrix3d exp_so3(const Eigen::Vector3d& rotation);

/// Angle between two orientations, in [0, pi]; accurate near 0 as well as near pi.
double angle_between(const Eigen::Matrix3d& R_1, const Eigen::Matrix3d& R_2);

/// Distance between two origins.
double distance_between(const Pose& X_1, const Pose& X_2);

/// A rotation whose z axis is the given direction (unit length not needed); x is chosen by a fixed rule.
Eigen::Matrix3d rotation_with_z(const Eigen::Vector3d& z_A);

/// The nearest rotation matrix: removes the drift of long products.
Pose orthonormalised(const Pose& X_AB);

/// Rotation orthonormal and right-handed within a tolerance, all numbers finite.
bool is_rigid(const Pose& X_AB, double tolerance = 1e-9);

}  // namespace binpick

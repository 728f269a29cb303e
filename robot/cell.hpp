// The cell as the robot knows it: bin, tray, table, camera (fixed X_WC or on the flange X_FC), arm and gripper.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/bin_spec.hpp"
#include "core/camera.hpp"
#include "core/config.hpp"
#include "robot/arm.hpp"
#include "robot/gripper.hpp"
#include "robot/trajectory.hpp"

namespace binpick {

struct TraySpec {
  Pose X_WT = pose_from_xyz_rpy({0.0, 0.0, 0.0}, {0, 0, 0});  ///< centre of the tray's inner floor
  Eigen::Vector3d inner_size = {0.4, 0.3, 0.05};              ///< m
  double wall = 0.005;
  void visit(ConfigVisitor& v);
};

struct CameraMount {
  std::string mount = "flange";     ///< flange | fixed
  Pose pose = Pose::Identity();     ///< X_FC on the flange, X_WC when fixed
  PinholeCamera intrinsics;         ///< the sensor preset's unless given
  bool has_intrinsics = false;
  void visit(ConfigVisitor& v);
};

/// `cell:` of a scene. Owns arm and gripper after finish().
struct Cell {
  BinSpec bin;
  Pose X_WB = Pose::Identity();
  TraySpec tray;
  CameraMount camera;
  std::string arm_path;             ///< URDF
  Pose X_WR = Pose::Identity();
  std::string gripper_type = "suction";
  std::shared_ptr<Gripper> gripper; ///< made while visiting
  std::shared_ptr<const Arm> arm;   ///< loaded by finish()
  MotionLimits motion;
  Vector6d q_look = Vector6d::Zero();   ///< rad, joint position of the look; with a flange camera it places the camera
  Vector6d q_home = Vector6d::Zero();   ///< rad, start and end of a cycle
  /// Fixed camera of the cell at joint position q, or the flange camera carried there: X_WC as believed.
  Pose camera_pose(const Vector6d& q) const;
  Pose tip_pose(const Vector6d& q) const;            ///< X_WG
  std::vector<Primitive> table_W() const;            ///< what the cell stands on (top at z = 0)
  std::vector<Primitive> tray_W() const;

  void visit(ConfigVisitor& v);
  void finish();          ///< loads the arm; throws AssetError
  void validate() const;  ///< throws SpecError: unreachable tray, home in collision, look pose outside the limits, ..
};

}  // namespace binpick

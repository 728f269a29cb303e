// The cell as the robot knows it: bin, tray, table, camera (fixed X_WC or on the flange X_FC), arm and gripper.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/bin_spec.hpp"
#include "core/camera.hpp"
#include "core/config.hpp"
#include "core/lens_distortion.hpp"
#include "robot/arm.hpp"
#include "robot/gripper.hpp"
#include "robot/trajectory.hpp"

namespace binpick {

struct TraySpec {
  Pose X_WT = pose_from_xyz_rpy({0.0, 0.0, 0.0}, {0, 0, 0});  ///< centre of the tray's inner floor
  Eigen::Vector3d inner_size = {0.4, 0.3, 0.05};              ///< m
  double wall = 0.005;                                        ///< m, walls and floor
  void visit(ConfigVisitor& v);
};

struct CameraMount {
  std::string mount = "flange";  ///< flange | fixed
  Pose pose = Pose::Identity();  ///< X_FC on the flange, X_WC when fixed
  PinholeCamera intrinsics;      ///< the sensor preset's unless given
  bool has_intrinsics = false;
  LensDistortion lens;  ///< of grey images; depth frames are rectified
  Eigen::Vector3d housing = {0.090, 0.025,
                             0.025};  ///< m, along x, y, z of C; its front lies in the plane of C's origin
  void visit(ConfigVisitor& v);
};

/// One of `cameras:`: a camera beside the first, same sensor model. A fixed one has no body that the arm could meet.
struct FurtherCamera : CameraMount {
  std::string name;
  FurtherCamera() { mount = "fixed"; }
  void visit(ConfigVisitor& v);
};

/// `look:` of a cell: exactly one of the three.
struct LookSpec {
  std::string by = "joints";     ///< joints | camera | tip
  std::vector<double> joints;    ///< rad
  Pose pose = Pose::Identity();  ///< wished X_WC (camera on the flange) or X_WG; solved nearest to home by finish()
  void visit(ConfigVisitor& v);
};

/// `cell:` of a scene. Owns arm and gripper after finish().
struct Cell {
  BinSpec bin;
  Pose X_WB = pose_from_xyz_rpy({0.495, 0, 0.005}, {0, 0, 0});
  TraySpec tray;
  CameraMount camera;                     ///< the first: its C is the frame of every view
  std::vector<FurtherCamera> cameras;     ///< further ones, whose clouds are fused with the first's
  std::string arm_path;                   ///< URDF
  std::vector<std::string> arm_packages;  ///< folders that hold package folders, for package:// names in the URDF
  std::string arm_tip;                    ///< link of the URDF that is F; empty: tool0, flange or the only end link
  Pose X_WR = Pose::Identity();
  std::string gripper_type = "suction";
  std::shared_ptr<Gripper> gripper;  ///< made while visiting
  std::shared_ptr<const Arm> arm;    ///< loaded by finish()
  MotionLimits motion;
  Vector6d q_look = Vector6d::Zero();  ///< rad, joint position of the look; with a flange camera it places the camera
  Vector6d q_home = (Vector6d() << 0, 0, 0, 0, 1.5707963267948966, 0).finished();  ///< rad, start and end of a cycle
  LookSpec look;
  std::size_t camera_count() const { return 1 + cameras.size(); }
  const CameraMount& camera_at(std::size_t k) const { return k == 0 ? camera : cameras[k - 1]; }
  /// Fixed camera k of the cell at joint position q, or the flange camera carried there: X_WC as believed.
  Pose camera_pose(const Vector6d& q, std::size_t k = 0) const;
  Pose tip_pose(const Vector6d& q) const;  ///< X_WG
  std::vector<Primitive> table_W() const;  ///< what the cell stands on (top at z = 0)
  std::vector<Primitive> tray_W() const;
  std::vector<Primitive> bin_W() const;  ///< as the robot believes it stands
  /// Housings and brackets of the cameras on the flange, in F; empty when all are fixed.
  std::vector<Primitive> camera_body_F() const;

  void visit(ConfigVisitor& v);
  void finish();  ///< loads the arm, solves `look`; throws AssetError, SpecError (look out of reach)
  /// After finish(). Throws SpecError: unreachable tray or bin, home or look in collision or outside the limits, ..
  void validate() const;
};

/// `key: path/to/cell.yaml` or `key: {bin: .., ..}`; written in full, so a stored scene needs no second file.
void visit_cell(ConfigVisitor& v, const char* key, Cell& cell);

}  // namespace binpick

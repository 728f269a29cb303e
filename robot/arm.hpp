// A 6-joint serial arm from a URDF: joints, limits, link shapes, forward kinematics. R is the robot base (the URDF's
// root link), F the flange (its tip link). Joint vectors are radians in URDF order and sign.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.hpp"
#include "core/primitive.hpp"

namespace binpick {

class NumericIk;
struct SerialChain;

/// Where an arm comes from.
struct ArmSource {
  std::string urdf;
  std::vector<std::string> packages;  ///< folders that hold package folders, for package:// names; tried in this order
  std::string tip;                    ///< link that is the flange F; empty: tool0, flange, or the only end link
};

struct JointLimits {
  double lower = 0, upper = 0;  ///< rad
  double speed = 0;             ///< rad/s
};

/// Spherical-wrist geometry in the parameters of Brandstoetter, Angerer, Hofbaur 2014 (OPW); physical_models C1, C3.
/// Frame O is the method's base (z along joint 1), E its end frame: X_RF = X_RO * X_OE(q_opw) * X_EF.
struct OpwParameters {
  double a1 = 0, a2 = 0, b = 0, c1 = 0, c2 = 0, c3 = 0, c4 = 0;  ///< m
  std::array<double, 6> offset{};                                ///< rad: q_opw = sign * q - offset
  std::array<int, 6> sign{1, 1, 1, 1, 1, 1};
  Pose X_RO = Pose::Identity();
  Pose X_EF = Pose::Identity();
};

class Arm {
 public:
  /// Reads a URDF: six revolute joints in a row, from any maker. Shapes are the collision geometry, or the visual one
  /// of a link that has none; meshes count as boxes around slices of them. Finds the closed form of its inverse
  /// kinematics (OPW) where its axes allow one. Inertia and effort are not read. Throws AssetError: missing or
  /// malformed file, missing mesh, not six revolute joints between root and tip, a limit or speed missing.
  static Arm load(const ArmSource& source);
  static Arm load(const std::string& urdf_path) { return load(ArmSource{urdf_path, {}, ""}); }

  Pose forward(const Vector6d& q) const;  ///< X_RF
  /// X_RL of the seven rigid links, base first; links that hang on fixed joints count to the link that carries them.
  std::vector<Pose> link_poses(const Vector6d& q) const;
  /// Collision primitives of every link, in the link's frame L; same order as link_poses.
  const std::vector<std::vector<Primitive>>& link_shapes() const { return link_shapes_; }
  const std::vector<std::string>& link_names() const { return link_names_; }
  const std::array<JointLimits, 6>& limits() const { return limits_; }
  bool within_limits(const Vector6d& q, double margin = 0) const;
  /// Parameters of the closed form, if there is one; otherwise why_numeric() says what stands against it.
  const std::optional<OpwParameters>& opw() const { return opw_; }
  const std::string& why_numeric() const { return why_numeric_; }
  /// Does the closed form agree with forward() to rounding? Files that write 1.5708 for a right angle need polishing.
  bool opw_is_exact() const { return opw_error_ < 1e-12; }
  const NumericIk& numeric() const { return *numeric_; }
  const std::string& flange_name() const { return flange_name_; }  ///< link that is F
  const std::vector<std::string>& mesh_files() const { return mesh_files_; }
  const std::string& name() const { return name_; }

 private:
  struct Joint {
    Pose X_before = Pose::Identity();  ///< fixed pose of the joint frame in its parent link
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  };
  void find_closed_form(const SerialChain& chain);

  std::string name_, flange_name_;
  std::vector<std::string> link_names_, mesh_files_;
  std::array<Joint, 6> joints_;
  Pose X_6F_ = Pose::Identity();  ///< flange in the last moving link
  std::array<JointLimits, 6> limits_;
  std::vector<std::vector<Primitive>> link_shapes_;
  std::optional<OpwParameters> opw_;
  double opw_error_ = 0;  ///< largest difference of a matrix entry between the closed form and forward()
  std::string why_numeric_;
  std::shared_ptr<const NumericIk> numeric_;
};

}  // namespace binpick

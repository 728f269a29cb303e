// The rotations that carry a part into itself. Poses of symmetric parts are compared, clustered and scored modulo these.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/pose.hpp"

namespace binpick {

/// The symmetry group of a part, acting in P: X_WP and X_WP * S look the same for every S of the group.
struct Symmetry {
  /// Finite members, identity first. With an axis: representatives (identity, and a half turn about a perpendicular
  /// axis when the part may be flipped).
  std::vector<Pose> finite = {Pose::Identity()};
  /// Any turn about this line, when set.
  struct Axis {
    Eigen::Vector3d direction_P = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d point_P = Eigen::Vector3d::Zero();
  };
  std::optional<Axis> axis;

  bool trivial() const { return finite.size() == 1 && !axis; }
};

/// part.yaml: {type: none | cyclic | dihedral | revolution, axis: [0,0,1], point: [0,0,0], order: 2, flip: true}.
struct SymmetrySpec {
  std::string type = "none";
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d perpendicular = Eigen::Vector3d::UnitX();  ///< axis of the half turns (dihedral, revolution with flip)
  Eigen::Vector3d point = Eigen::Vector3d::Zero();           ///< m, a point on the axis
  int order = 2;                                             ///< cyclic and dihedral: turns of 2 pi / order
  bool flip = false;                                         ///< revolution: upside down looks the same

  void visit(ConfigVisitor& v);
  void validate() const;
};

Symmetry make_symmetry(const SymmetrySpec& spec);

/// The pose X_AP * S (S in the group) nearest to X_AP_ref: least rotation angle, then the one whose turn about a
/// continuous axis is optimal in closed form.
Pose nearest_equivalent(const Pose& X_AP, const Pose& X_AP_ref, const Symmetry& symmetry);

/// The group as a finite list of poses S: `turns` samples of a continuous axis times the finite members.
std::vector<Pose> sampled_group(const Symmetry& symmetry, int turns);

}  // namespace binpick

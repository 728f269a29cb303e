// The rotations that carry a part into itself. Poses of symmetric parts are compared, clustered and scored modulo
// these. Frame P is the part as drawn; the axis and the centre of a symmetry need not pass through its origin, so
// members carry a translation too: S = {R, point - R point}. Metres and radians.
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
  /// Any rotation about this point, when set: a sphere. Then `finite` and `axis` add nothing.
  std::optional<Eigen::Vector3d> center_P;

  bool trivial() const { return finite.size() == 1 && !axis && !center_P; }
};

/// part.yaml: {type: auto | none | cyclic | dihedral | revolution | sphere, axis: [0,0,1], point: [0,0,0], order: 2,
/// flip: true}. `auto` is found from the envelope (core/symmetry_detection).
struct SymmetrySpec {
  std::string type = "none";
  double tolerance = 0.01;  ///< auto: how far a turned surface may lie from itself, as a share of the diameter
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d perpendicular = Eigen::Vector3d::UnitX();  ///< dihedral: axis of one of the half turns
  Eigen::Vector3d point = Eigen::Vector3d::Zero();           ///< m, a point on the axis; with a flip, the centre
  int order = 2;                                             ///< cyclic and dihedral: turns of 2 pi / order
  bool flip = false;                                         ///< revolution: upside down looks the same

  void visit(ConfigVisitor& v);
  void validate() const;
};

/// Of every type but `auto`, which needs a mesh.
Symmetry make_symmetry(const SymmetrySpec& spec);

/// The pose X_AP * S (S in the group) nearest to X_AP_ref: least rotation angle; the turn about a continuous axis is
/// the optimum in closed form. The group fixes a point (or a line) of the part, which no choice of S moves: the
/// rotation alone decides, and at equal angles the nearer origin, then the earlier member.
Pose nearest_equivalent(const Pose& X_AP, const Pose& X_AP_ref, const Symmetry& symmetry);

/// The group as a finite list of poses S, identity first: `turns` samples of a continuous axis times the finite
/// members; of a sphere turns * turns rotations spread evenly.
std::vector<Pose> sampled_group(const Symmetry& symmetry, int turns);

}  // namespace binpick

// Small parts with known symmetries, for the tests of this folder.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/part.hpp"
#include "core/primitive.hpp"
#include "core/random.hpp"

namespace binpick::examples {

inline Part part_of(const std::string& name, const TriangleMesh& mesh_P, const SymmetrySpec& symmetry = {}) {
  Part part;
  part.name = name;
  part.mesh_P = mesh_P;
  part.symmetry = make_symmetry(symmetry);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& a : mesh_P.vertices) {
    box.extend(a);
    for (const Eigen::Vector3d& b : mesh_P.vertices) part.diameter = std::max(part.diameter, (a - b).norm());
  }
  part.box_center_P = box.center();
  return part;
}

inline Pose moved_to(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}

/// A plain box, which looks the same after half turns about its three axes. Drawn away from the origin.
inline Part box() {
  SymmetrySpec symmetry;
  symmetry.type = "dihedral";
  symmetry.point = Eigen::Vector3d(0.1, 0.05, -0.02);
  return part_of("box", mesh_of(Primitive::box({0.08, 0.05, 0.03}, moved_to(0.1, 0.05, -0.02))), symmetry);
}

/// A flat disc: any turn about z, and upside down. Drawn away from the origin.
inline Part disc() {
  SymmetrySpec symmetry;
  symmetry.type = "revolution";
  symmetry.flip = true;
  symmetry.point = Eigen::Vector3d(0.02, -0.03, 0.04);
  return part_of("disc", mesh_of(Primitive::cylinder(0.05, 0.016, moved_to(0.02, -0.03, 0.04))), symmetry);
}

/// A stepped shaft along z: any turn, but not upside down.
inline Part shaft() {
  SymmetrySpec symmetry;
  symmetry.type = "revolution";
  TriangleMesh mesh = mesh_of(Primitive::cylinder(0.02, 0.06, moved_to(0, 0, 0.03)));
  append(mesh, mesh_of(Primitive::cylinder(0.01, 0.04, moved_to(0, 0, 0.08))));
  return part_of("shaft", mesh, symmetry);
}

/// Two unequal arms: no symmetry.
inline Part bracket() {
  TriangleMesh mesh = mesh_of(Primitive::box({0.09, 0.06, 0.006}, moved_to(0.045, 0.03, 0.003)));
  append(mesh, mesh_of(Primitive::box({0.006, 0.06, 0.06}, moved_to(0.003, 0.03, 0.03))));
  append(mesh, mesh_of(Primitive::box({0.01, 0.01, 0.01}, moved_to(0.07, 0.05, 0.01))));
  return part_of("bracket", mesh);
}

inline Part ball() {
  SymmetrySpec symmetry;
  symmetry.type = "sphere";
  symmetry.point = Eigen::Vector3d(0, 0.01, 0);
  return part_of("ball", mesh_of(Primitive::sphere(0.02, moved_to(0, 0.01, 0)), 24), symmetry);
}

inline std::vector<Part> all() { return {box(), disc(), shaft(), bracket(), ball()}; }

inline Pose random_pose(Rng& rng) {
  Pose X = Pose::Identity();
  X.linear() = rng.rotation().toRotationMatrix();
  X.translation() = Eigen::Vector3d(rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2));
  return X;
}

inline Pose turn(const Eigen::Vector3d& point, const Eigen::Vector3d& axis, double angle) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  X.translation() = point - X.linear() * point;
  return X;
}

/// A random member of the part's symmetry group.
inline Pose random_member(const Symmetry& symmetry, Rng& rng) {
  const Pose& member = symmetry.finite[rng.below(symmetry.finite.size())];
  if (symmetry.axis) return member * turn(symmetry.axis->point_P, symmetry.axis->direction_P, rng.uniform(0, 6.28));
  if (symmetry.center_P) return turn(*symmetry.center_P, rng.unit_vector(), rng.uniform(0, 3.14));
  return member;
}

}  // namespace binpick::examples

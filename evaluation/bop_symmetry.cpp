#include "evaluation/bop_symmetry.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "core/check.hpp"

namespace binpick {
namespace {

constexpr double kParallel = 1e-6;  // sine of an angle between axes, and share of a metre between points

Pose turn_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& point, double angle) {
  Pose S = Pose::Identity();
  S.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  S.translation() = point - S.linear() * point;
  return S;
}

bool same_line(const BopSymmetries::Turns& a, const BopSymmetries::Turns& b) {
  return a.axis.cross(b.axis).norm() < kParallel && a.axis.cross(a.offset - b.offset).norm() < kParallel;
}

/// Where two lines meet; nothing when they are parallel or pass each other.
std::optional<Eigen::Vector3d> meeting(const BopSymmetries::Turns& a, const BopSymmetries::Turns& b) {
  const Eigen::Vector3d across = a.axis.cross(b.axis);
  if (across.norm() < kParallel) return std::nullopt;
  const Eigen::Vector3d apart = b.offset - a.offset;
  if (std::abs(apart.dot(across.normalized())) > kParallel) return std::nullopt;
  return a.offset + a.axis * (apart.cross(b.axis).dot(across) / across.squaredNorm());
}

Symmetry as_list(const BopSymmetries& listed) {
  Symmetry symmetry;
  symmetry.finite = toolkit_group(listed);
  return symmetry;
}

}  // namespace

std::vector<Pose> toolkit_group(const BopSymmetries& listed, double step) {
  BP_CHECK(step > 0, "step " << step);
  std::vector<Pose> discrete = {Pose::Identity()};
  discrete.insert(discrete.end(), listed.discrete.begin(), listed.discrete.end());
  if (listed.continuous.empty()) return discrete;
  const int turns = static_cast<int>(std::ceil(std::numbers::pi / step));
  std::vector<Pose> group;
  for (const Pose& member : discrete)
    for (const BopSymmetries::Turns& line : listed.continuous)
      for (int k = 0; k < turns; ++k)
        group.push_back(turn_about(line.axis.normalized(), line.offset, 2 * std::numbers::pi * k / turns) * member);
  return group;
}

Symmetry closed_form(const BopSymmetries& listed) {
  Symmetry symmetry;
  if (!listed.continuous.empty()) {
    BopSymmetries::Turns first = listed.continuous.front();
    first.axis.normalize();
    symmetry.axis = Symmetry::Axis{first.axis, first.offset};
    for (BopSymmetries::Turns other : listed.continuous) {
      other.axis.normalize();
      if (same_line(first, other)) continue;
      const auto center = meeting(first, other);
      const bool another = center && symmetry.center_P && (*center - *symmetry.center_P).norm() > kParallel;
      if (!center || another) return as_list(listed);
      symmetry.center_P = center;
    }
  }
  for (const Pose& member : listed.discrete) {
    if (symmetry.center_P && (member * *symmetry.center_P - *symmetry.center_P).norm() > kParallel)
      return as_list(listed);
    if (symmetry.axis && !symmetry.center_P) {
      const BopSymmetries::Turns line{symmetry.axis->direction_P, symmetry.axis->point_P};
      if (!same_line(line, {member.linear() * line.axis, member * line.offset})) return as_list(listed);
    }
    if (!symmetry.center_P) symmetry.finite.push_back(member);
  }
  return symmetry;
}

BopSymmetries bop_symmetries(const Symmetry& symmetry) {
  BopSymmetries listed;
  if (symmetry.center_P) {
    for (int k = 0; k < 3; ++k) listed.continuous.push_back({Eigen::Vector3d::Unit(k), *symmetry.center_P});
    return listed;
  }
  listed.discrete.assign(symmetry.finite.begin() + 1, symmetry.finite.end());
  if (symmetry.axis) listed.continuous.push_back({symmetry.axis->direction_P, symmetry.axis->point_P});
  return listed;
}

Symmetry symmetry_in(const Symmetry& symmetry_P, const Pose& X_PO) {
  Symmetry symmetry_O = symmetry_P;
  const Pose X_OP = X_PO.inverse();
  for (Pose& member : symmetry_O.finite) member = X_OP * member * X_PO;
  if (symmetry_O.axis)
    symmetry_O.axis = {X_OP.linear() * symmetry_P.axis->direction_P, X_OP * symmetry_P.axis->point_P};
  if (symmetry_O.center_P) symmetry_O.center_P = X_OP * *symmetry_P.center_P;
  return symmetry_O;
}

}  // namespace binpick

#include "core/symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.hpp"
#include "core/error.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;

struct Problem {
  const char* key;
  std::string text;
};

std::optional<Problem> problem_of(const SymmetrySpec& spec) {
  const bool about_axis = spec.type == "cyclic" || spec.type == "dihedral" || spec.type == "revolution";
  if (!about_axis && spec.type != "auto" && spec.type != "none" && spec.type != "sphere") {
    return Problem{"type", "is one of auto, none, cyclic, dihedral, revolution, sphere, not '" + spec.type + "'"};
  }
  if (!(spec.tolerance >= 1e-4 && spec.tolerance <= 0.1)) return Problem{"tolerance", "must lie in 0.0001 .. 0.1"};
  if (!spec.point.allFinite()) return Problem{"point", "must be finite"};
  if (!about_axis) return std::nullopt;
  if (!spec.axis.allFinite() || spec.axis.norm() < 1e-9) return Problem{"axis", "must not be zero"};
  if (spec.type == "revolution") return std::nullopt;
  if (spec.order < 1 || spec.order > 360 || (spec.type == "cyclic" && spec.order < 2)) {
    return Problem{"order", "must lie in 2 .. 360 (dihedral: 1 .. 360)"};
  }
  if (spec.type == "cyclic") return std::nullopt;
  const Eigen::Vector3d& across = spec.perpendicular;
  if (!across.allFinite() || across.norm() < 1e-9 || std::abs(across.normalized().dot(spec.axis.normalized())) > 1e-3) {
    return Problem{"perpendicular", "must be at a right angle to the axis"};
  }
  return std::nullopt;
}

/// Turn about the line through `point`; entries that are 0 or +-1 but for rounding are made so, which keeps half and
/// quarter turns exact.
Pose turn_about(const Eigen::Vector3d& point, const Eigen::Vector3d& axis, double angle) {
  Eigen::Matrix3d R = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  for (double& entry : R.reshaped()) {
    if (std::abs(entry - std::round(entry)) < 1e-15) entry = std::round(entry);
  }
  Pose S = Pose::Identity();
  S.linear() = R;
  S.translation() = point - R * point;
  return S;
}

/// The turn about the axis that maximises trace(R_ref^T R_AP R_axis(angle)), that is, minimises the rotation left over.
/// With M = R_ref^T R_AP and u the axis: trace = u.Mu + cos(angle) (tr M - u.Mu) + sin(angle) tr(M [u]x).
double best_turn(const Eigen::Matrix3d& M, const Eigen::Vector3d& u) {
  const double cosine_part = M.trace() - u.dot(M * u);
  const double sine_part = u.x() * (M(1, 2) - M(2, 1)) + u.y() * (M(2, 0) - M(0, 2)) + u.z() * (M(0, 1) - M(1, 0));
  if (std::hypot(cosine_part, sine_part) < 1e-12) return 0;  // axes opposite: every turn is equally far
  return std::atan2(sine_part, cosine_part);
}

/// Rotations spread evenly over SO(3): the super-Fibonacci spiral (Alexa, CVPR 2022), identity put first.
std::vector<Pose> sphere_rotations(const Eigen::Vector3d& center_P, int count) {
  const double phi = std::numbers::sqrt2;
  const double psi = 1.533751168755204288118041;  // root of psi^4 = psi + 4
  std::vector<Pose> group = {Pose::Identity()};
  for (int i = 0; i < count - 1; ++i) {
    const double s = i + 0.5, t = s / (count - 1), alpha = 2 * kPi * s / phi, beta = 2 * kPi * s / psi;
    const double r = std::sqrt(t), R = std::sqrt(1 - t);
    const Eigen::Quaterniond q(R * std::cos(beta), r * std::sin(alpha), r * std::cos(alpha), R * std::sin(beta));
    Pose S = Pose::Identity();
    S.linear() = q.normalized().toRotationMatrix();
    S.translation() = center_P - S.linear() * center_P;
    group.push_back(S);
  }
  return group;
}

}  // namespace

void SymmetrySpec::visit(ConfigVisitor& v) {
  v.choice("type", type, {"auto", "none", "cyclic", "dihedral", "revolution", "sphere"},
           "rotations that carry the part into itself: auto: found from the mesh; none; cyclic: turns of 360 deg / "
           "order; dihedral: those and half "
           "turns across; revolution: any turn about the axis; sphere: any rotation about the point");
  v.field("tolerance", tolerance, Unit::kNone, "auto: deviation allowed, as a share of the diameter");
  v.field("axis", axis, Unit::kNone, "direction of the axis in the part's frame");
  v.field("perpendicular", perpendicular, Unit::kNone, "dihedral: axis of one of the half turns, across the axis");
  v.field("point", point, Unit::kLength, "a point on the axis; with half turns or a flip, the centre");
  v.field("order", order, "cyclic and dihedral: number of turns that look alike");
  v.field("flip", flip, "revolution: upside down looks the same");
  if (!v.reading()) return;
  if (const auto problem = problem_of(*this)) v.fail(problem->key, problem->text);
}

void SymmetrySpec::validate() const {
  if (const auto problem = problem_of(*this)) {
    throw SpecError(std::string("symmetry.") + problem->key + ": " + problem->text);
  }
}

Symmetry make_symmetry(const SymmetrySpec& spec) {
  spec.validate();
  BP_CHECK(spec.type != "auto", "detect_symmetry finds it");
  Symmetry symmetry;
  if (spec.type == "none") return symmetry;
  if (spec.type == "sphere") {
    symmetry.center_P = spec.point;
    return symmetry;
  }
  const Eigen::Vector3d axis = spec.axis.normalized();
  if (spec.type == "revolution") {
    symmetry.axis = Symmetry::Axis{axis, spec.point};
    if (spec.flip) symmetry.finite.push_back(turn_about(spec.point, axis.unitOrthogonal(), kPi));
    return symmetry;
  }
  for (int k = 1; k < spec.order; ++k) {
    symmetry.finite.push_back(turn_about(spec.point, axis, 2 * kPi * k / spec.order));
  }
  if (spec.type == "cyclic") return symmetry;
  const Eigen::Vector3d across = (spec.perpendicular - axis * axis.dot(spec.perpendicular)).normalized();
  const Pose half_turn = turn_about(spec.point, across, kPi);
  for (int k = 0; k < spec.order; ++k)
    symmetry.finite.push_back(symmetry.finite[static_cast<std::size_t>(k)] * half_turn);
  return symmetry;
}

Pose nearest_equivalent(const Pose& X_AP, const Pose& X_AP_ref, const Symmetry& symmetry) {
  BP_CHECK(!symmetry.finite.empty());
  if (symmetry.center_P) {
    Pose X_AP_twin = X_AP_ref;  // same rotation as the reference, same centre as the part
    X_AP_twin.translation() = X_AP * *symmetry.center_P - X_AP_ref.linear() * *symmetry.center_P;
    return X_AP_twin;
  }
  // Equal angles occur between distinct members only far from zero angle, where trace and angle resolve alike.
  constexpr double kSameTrace = 1e-9;
  Pose best = X_AP;
  double best_trace = 0, best_distance = 0;
  for (std::size_t i = 0; i < symmetry.finite.size(); ++i) {
    Pose X_AP_twin = X_AP * symmetry.finite[i];
    if (symmetry.axis) {
      const Eigen::Matrix3d M = X_AP_ref.linear().transpose() * X_AP_twin.linear();
      const Symmetry::Axis& axis = *symmetry.axis;
      X_AP_twin = X_AP_twin * turn_about(axis.point_P, axis.direction_P, best_turn(M, axis.direction_P));
    }
    const double trace = X_AP_ref.linear().cwiseProduct(X_AP_twin.linear()).sum();
    const double distance = (X_AP_twin.translation() - X_AP_ref.translation()).norm();
    const bool nearer_origin = trace > best_trace - kSameTrace && distance < best_distance - kSameTrace;
    if (i == 0 || trace > best_trace + kSameTrace || nearer_origin) {
      best = X_AP_twin;
      best_trace = trace;
      best_distance = distance;
    }
  }
  return best;
}

std::vector<Pose> sampled_group(const Symmetry& symmetry, int turns) {
  BP_CHECK(turns >= 1, "turns " << turns);
  if (symmetry.center_P) return sphere_rotations(*symmetry.center_P, turns * turns);
  if (!symmetry.axis) return symmetry.finite;
  std::vector<Pose> group;
  for (const Pose& member : symmetry.finite) {
    for (int k = 0; k < turns; ++k) {
      const Pose turn = turn_about(symmetry.axis->point_P, symmetry.axis->direction_P, 2 * kPi * k / turns);
      group.push_back(member * turn);
    }
  }
  return group;
}

}  // namespace binpick

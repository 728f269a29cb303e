#include "robot/inverse_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/numeric_ik.hpp"
#include "robot/opw_geometry.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;
// Wrists with sin(q5) below this count as singular: only q4 + q6 (or q4 - q6) is defined there, so q4 is given.
constexpr double kSingular = 1e-9;
// A cosine may leave [-1, 1] by this much and still mean "fully stretched"; more where what comes out is polished.
constexpr double kStretch = 1e-12;
constexpr double kLooseStretch = 1e-4;
constexpr double kSame = 1e-6;  // rad: solutions that polishing has brought together

double wrapped(double angle) {
  const double turned = std::remainder(angle, 2 * kPi);
  return turned <= -kPi ? kPi : turned;
}

/// Two wrists that carry R_ce = Rz(q4) Ry(q5) Rz(q6); one when it is singular.
void add_wrists(const Eigen::Matrix3d& R_ce, double q4_singular, Vector6d q, std::vector<Vector6d>& out) {
  const double sine = std::hypot(R_ce(0, 2), R_ce(1, 2));
  const bool singular = sine < kSingular;
  const double q4_first = singular ? q4_singular : std::atan2(R_ce(1, 2), R_ce(0, 2));
  for (int flip = 0; flip < (singular ? 1 : 2); ++flip) {
    q[3] = q4_first + flip * kPi;
    const Eigen::Matrix3d M = Eigen::AngleAxisd(-q[3], Eigen::Vector3d::UnitZ()) * R_ce;
    q[4] = std::atan2(M(0, 2), M(2, 2));
    q[5] = std::atan2(M(1, 0), M(1, 1));
    out.push_back(q);
  }
}

/// Closed form of Brandstoetter, Angerer, Hofbaur 2014: shoulder x elbow x wrist.
std::vector<Vector6d> opw_branches(const OpwParameters& opw, const Pose& X_OE, double q4_singular, double stretch) {
  std::vector<Vector6d> out;
  const Eigen::Vector3d p_wrist = X_OE.translation() - opw.c4 * X_OE.linear().col(2);
  const double reach_squared = p_wrist.head<2>().squaredNorm() - opw.b * opw.b;
  if (reach_squared < -stretch * opw.b * opw.b) return out;
  const double k = std::hypot(opw.a2, opw.c3), psi = std::atan2(opw.a2, opw.c3);
  for (const double front : {1.0, -1.0}) {
    const double x_wrist = front * std::sqrt(std::max(0.0, reach_squared));
    const double q1 = std::atan2(p_wrist.y(), p_wrist.x()) - std::atan2(opw.b, x_wrist);
    const double x = x_wrist - opw.a1, z = p_wrist.z() - opw.c1;
    const double cosine = (x * x + z * z - opw.c2 * opw.c2 - k * k) / (2 * opw.c2 * k);
    if (std::abs(cosine) > 1 + stretch) continue;
    const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
    for (const double elbow : {1.0, -1.0}) {
      if (elbow < 0 && sine == 0) continue;
      const double g = std::atan2(elbow * sine, cosine);  // q3 + psi
      Vector6d q = Vector6d::Zero();
      q[0] = q1;
      q[1] = std::atan2(x, z) - std::atan2(k * std::sin(g), opw.c2 + k * std::cos(g));
      q[2] = g - psi;
      const Eigen::Matrix3d R_Oc =
          (Eigen::AngleAxisd(q[0], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(q[1] + q[2], Eigen::Vector3d::UnitY()))
              .toRotationMatrix();
      add_wrists(R_Oc.transpose() * X_OE.linear(), q4_singular, q, out);
    }
  }
  return out;
}

bool same(const Vector6d& a, const Vector6d& b) {
  for (int i = 0; i < 6; ++i)
    if (std::abs(wrapped(a[i] - b[i])) > kSame) return false;
  return true;
}

/// From the solutions of the ideal arm to those of a file whose angles are rounded. Where the ideal arm is singular or
/// out of reach the file's own arm need not be, so that q_near is a start too.
std::vector<Vector6d> polished(const Arm& arm, const Pose& X_RF, const std::vector<Vector6d>& ideal,
                               const Vector6d& q_near) {
  std::vector<Vector6d> found;
  const auto add = [&](const std::optional<Vector6d>& q) {
    if (q && std::none_of(found.begin(), found.end(), [&](const Vector6d& known) { return same(known, *q); }))
      found.push_back(*q);
  };
  add(arm.numeric().polished(X_RF, q_near));
  for (const Vector6d& q : ideal) add(arm.numeric().near(X_RF, q));
  return found;
}

std::vector<Vector6d> closed_form_branches(const Arm& arm, const Pose& X_RF, const Vector6d& q_near) {
  const OpwParameters& opw = *arm.opw();
  const Pose X_OE = opw.X_RO.inverse() * X_RF * opw.X_EF.inverse();
  const double q4_singular = opw.sign[3] * q_near[3] - opw.offset[3];
  std::vector<Vector6d> found = opw_branches(opw, X_OE, q4_singular, arm.opw_is_exact() ? kStretch : kLooseStretch);
  for (Vector6d& q : found) q = from_opw(opw, q);
  return arm.opw_is_exact() ? found : polished(arm, X_RF, found, q_near);
}

std::vector<Vector6d> branches(const Arm& arm, const Pose& X_RF, const Vector6d& q_near) {
  std::vector<Vector6d> found =
      arm.opw() ? closed_form_branches(arm, X_RF, q_near) : arm.numeric().branches(X_RF, q_near).q;
  for (Vector6d& q : found)
    for (int i = 0; i < 6; ++i) q[i] = wrapped(q[i]);
  return found;
}

/// Adds every whole turn of joint i that the limits allow, for all joints from i on.
void add_turns(const Arm& arm, const Vector6d& q, int i, std::vector<Vector6d>& out) {
  if (i == 6) {
    out.push_back(q);
    return;
  }
  const JointLimits& limits = arm.limits()[static_cast<std::size_t>(i)];
  for (int turn = -3; turn <= 3; ++turn) {
    Vector6d turned = q;
    turned[i] += turn * 2 * kPi;
    if (turned[i] >= limits.lower && turned[i] <= limits.upper) add_turns(arm, turned, i + 1, out);
  }
}

/// The turn of joint i nearest to `near` within its limits, if any lies there.
std::optional<double> nearest_turn(const JointLimits& limits, double angle, double near) {
  std::optional<double> best;
  for (int turn = -3; turn <= 3; ++turn) {
    const double turned = angle + turn * 2 * kPi;
    if (turned < limits.lower || turned > limits.upper) continue;
    if (!best || std::abs(turned - near) < std::abs(*best - near)) best = turned;
  }
  return best;
}

void sort_by_motion(std::vector<Vector6d>& solutions, const Vector6d& q_near) {
  const auto motion = [&](const Vector6d& q) { return (q - q_near).cwiseAbs().maxCoeff(); };
  std::stable_sort(solutions.begin(), solutions.end(),
                   [&](const Vector6d& a, const Vector6d& b) { return motion(a) < motion(b); });
}

}  // namespace

std::vector<Vector6d> all_branches(const Arm& arm, const Pose& X_RF) { return branches(arm, X_RF, Vector6d::Zero()); }

std::vector<Vector6d> inverse_kinematics(const Arm& arm, const Pose& X_RF, const Vector6d& q_near) {
  std::vector<Vector6d> solutions;
  for (const Vector6d& q : branches(arm, X_RF, q_near)) add_turns(arm, q, 0, solutions);
  sort_by_motion(solutions, q_near);
  return solutions;
}

std::vector<Vector6d> nearest_postures(const Arm& arm, const Pose& X_RF, const Vector6d& q_near) {
  std::vector<Vector6d> solutions;
  for (Vector6d q : branches(arm, X_RF, q_near)) {
    bool within = true;
    for (int i = 0; i < 6 && within; ++i) {
      const auto turned = nearest_turn(arm.limits()[static_cast<std::size_t>(i)], q[i], q_near[i]);
      within = turned.has_value();
      if (within) q[i] = *turned;
    }
    if (within) solutions.push_back(q);
  }
  sort_by_motion(solutions, q_near);
  return solutions;
}

bool turns_freely(const Arm& arm) {
  double turns = 1;
  for (const JointLimits& limits : arm.limits())
    turns *= std::max(1.0, std::floor((limits.upper - limits.lower) / (2 * kPi) + 1e-6));
  return turns > 4;
}

std::optional<Vector6d> following_solution(const Arm& arm, const Pose& X_RF, const Vector6d& q_near) {
  if (arm.opw() && arm.opw_is_exact()) {
    const std::vector<Vector6d> solutions = inverse_kinematics(arm, X_RF, q_near);
    return solutions.empty() ? std::nullopt : std::optional(solutions.front());
  }
  const std::optional<Vector6d> q = arm.numeric().near(X_RF, q_near);
  return q && arm.within_limits(*q) ? q : std::nullopt;
}

bool has_solution(const Arm& arm, const Pose& X_RF, const Vector6d& q_near) {
  if (!arm.opw()) {
    std::optional<Vector6d> q = arm.numeric().near(X_RF, q_near);
    if (q) {
      for (int i = 0; i < 6; ++i) (*q)[i] = wrapped((*q)[i]);
      std::vector<Vector6d> within;
      add_turns(arm, *q, 0, within);
      if (!within.empty()) return true;
    }
  }
  return !inverse_kinematics(arm, X_RF, q_near).empty();
}

}  // namespace binpick

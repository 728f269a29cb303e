#include "robot/parallel_axes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace binpick {
namespace {

using Vector = Eigen::Vector3d;
constexpr double kTolerance = 1e-4;  // rad and m
constexpr double kStretch = 1e-4;    // a cosine beyond one by this still counts: what comes out is polished
constexpr double kSingular = 1e-7;   // sine of the wrist's angle
constexpr int kTries = 8;            // turns of joint 6 of a singular wrist

Eigen::Matrix3d turn(const Vector& axis, double angle) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }
const Vector kY = Vector::UnitY(), kZ = Vector::UnitZ();

/// Angle about the unit axis that turns `from` into `to`, seen along it.
double angle_about(const Vector& axis, const Vector& from, const Vector& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to) - axis.dot(from) * axis.dot(to));
}

/// Angle about y from z.
double lean_of(const Vector& v) { return std::atan2(v.x(), v.z()); }
Vector in_plane(const Vector& v) { return {v.x(), 0, v.z()}; }

}  // namespace

std::optional<ParallelAxes> ParallelAxes::find(const SerialChain& chain) {
  std::array<Vector, 6> p, u;  // points on the axes and their directions in R, at the zero position
  Pose X = Pose::Identity();
  for (std::size_t i = 0; i < 6; ++i) {
    X = X * chain.X_before[i];
    p[i] = X.translation();
    u[i] = X.linear() * chain.axes[i];
  }
  const Pose X_RF = X * chain.X_6F;
  const auto off = [&](std::size_t i, std::size_t j) { return std::abs(u[i].dot(u[j])); };
  if (std::max({off(0, 1), off(3, 4), off(4, 5)}) > kTolerance) return std::nullopt;
  if (std::max(u[1].cross(u[2]).norm(), u[1].cross(u[3]).norm()) > kTolerance) return std::nullopt;
  // Axes 5 and 6 are perpendicular: the point of 6 that lies nearest to 5.
  const Vector wrist = p[5] + u[5] * u[5].dot(p[4] - p[5]);
  if (u[4].cross(wrist - p[4]).norm() > kTolerance) return std::nullopt;
  ParallelAxes arm;
  const Vector z = u[0], y = (u[1] - z * z.dot(u[1])).normalized();
  arm.X_RO_.linear() << y.cross(z), y, z;
  arm.X_RO_.translation() = p[0];
  const Eigen::Matrix3d R_OR = arm.X_RO_.linear().transpose();
  for (const std::size_t i : {2u, 3u}) arm.sign_[i] = u[i].dot(y) < 0 ? -1 : 1;
  arm.shoulder_ = in_plane(R_OR * (p[1] - p[0]));
  arm.upper_ = in_plane(R_OR * (p[2] - p[1]));
  arm.fore_ = in_plane(R_OR * (p[3] - p[2]));
  arm.hand_ = R_OR * (wrist - p[3]);
  arm.hand_.y() = (R_OR * (wrist - p[0])).y();  // sideways from the plane of axis 1, not from that of axis 4
  if (arm.upper_.norm() < 1e-3 || arm.fore_.norm() < 1e-3) return std::nullopt;
  arm.u5_ = in_plane(R_OR * u[4]).normalized();
  arm.u6_ = (R_OR * u[5] - arm.u5_ * arm.u5_.dot(R_OR * u[5])).normalized();
  arm.R_OF_ = R_OR * X_RF.linear();
  arm.p_F_wrist_ = X_RF.inverse() * wrist;
  return arm;
}

/// With M = R_OF turned back by joint 1 and by R_OF at zero: M = Ry(lean) R(u5, t5) R(u6, t6).
std::vector<ParallelAxes::Wrist> ParallelAxes::wrists(const Eigen::Matrix3d& M, const Vector& p_wrist,
                                                      double t6_near) const {
  // u6 has the angle `zero` from y about u5; y . M u6 = cos(zero + t5), whatever the others are.
  const double zero = angle_about(u5_, kY, u6_);
  const double bend = std::acos(std::clamp(kY.dot(M * u6_), -1.0, 1.0));
  std::vector<Wrist> found;
  const auto add = [&](double t5, double t6) {
    const Eigen::Matrix3d R = M * turn(u6_, -t6) * turn(u5_, -t5);
    found.push_back({t5, t6, std::atan2(R(0, 2), R(2, 2))});
  };
  if (std::sin(bend) < kSingular) {
    // Axis 6 stands parallel to the other three: any turn about it will do, of which not every one lets the elbow
    // reach. The one that does if any does has the hand point away from the shoulder.
    for (int k = 0; k < kTries; ++k) add(bend - zero, t6_near + 2 * std::numbers::pi * k / kTries);
    const double away = lean_of(p_wrist - shoulder_) - lean_of(hand_);
    const Eigen::Matrix3d rest = turn(u5_, zero - bend) * turn(kY, -away) * M;
    add(bend - zero, angle_about(u6_, u5_, rest * u5_));
    return found;
  }
  for (const double side : {1.0, -1.0}) {
    const double t5 = side * bend - zero;
    add(t5, angle_about(u6_, M.transpose() * kY, turn(u5_, -t5) * kY));
  }
  return found;
}

/// Two links in the plane of the parallel axes, from the shoulder to axis 4.
void ParallelAxes::add_elbows(double t1, const Wrist& wrist, const Vector& p_wrist, std::vector<Vector6d>& out) const {
  const Vector way = in_plane(p_wrist - turn(kY, wrist.lean) * hand_) - shoulder_;
  const double a = upper_.norm(), b = fore_.norm();
  const double cosine = (way.squaredNorm() - a * a - b * b) / (2 * a * b);
  if (std::abs(cosine) > 1 + kStretch) return;
  const double bend = std::acos(std::clamp(cosine, -1.0, 1.0));  // of the forearm's direction from the upper arm's
  for (const double elbow : {bend, -bend}) {
    const double upper_lean = lean_of(way) - std::atan2(b * std::sin(elbow), a + b * std::cos(elbow));
    const double t2 = upper_lean - lean_of(upper_);
    const double t3 = elbow - (lean_of(fore_) - lean_of(upper_));
    const double t4 = wrist.lean - t2 - t3;
    Vector6d q;
    q << t1, t2, sign_[2] * t3, sign_[3] * t4, wrist.t5, wrist.t6;
    out.push_back(q);
  }
}

std::vector<Vector6d> ParallelAxes::branches(const Pose& X_RF, const Vector6d& q_near) const {
  std::vector<Vector6d> out;
  const Vector p_wrist = X_RO_.inverse() * (X_RF * p_F_wrist_);
  const double aside = hand_.y();
  const double reach_squared = p_wrist.head<2>().squaredNorm() - aside * aside;
  if (reach_squared < -kStretch * aside * aside) return out;
  for (const double front : {1.0, -1.0}) {
    const double ahead = front * std::sqrt(std::max(0.0, reach_squared));
    const double t1 = std::atan2(p_wrist.y(), p_wrist.x()) - std::atan2(aside, ahead);
    const Eigen::Matrix3d back = turn(kZ, -t1);
    const Eigen::Matrix3d M = back * X_RO_.linear().transpose() * X_RF.linear() * R_OF_.transpose();
    for (const Wrist& wrist : wrists(M, back * p_wrist, q_near[5])) add_elbows(t1, wrist, back * p_wrist, out);
  }
  return out;
}

}  // namespace binpick

#include "robot/opw_geometry.hpp"

#include <cmath>
#include <numbers>

namespace binpick {
namespace {

// Foreign URDFs round their angles (1.5708) and lengths; what they round away must not make them foreign to us.
constexpr double kAngleTolerance = 1e-4;   // rad
constexpr double kLengthTolerance = 1e-4;  // m

using Vector = Eigen::Vector3d;

struct Line {
  Vector point, direction;
};

std::array<Line, 6> axes_in_base(const SerialChain& chain, Pose& X_RF) {
  std::array<Line, 6> axes;
  Pose X = Pose::Identity();
  for (std::size_t i = 0; i < 6; ++i) {
    X = X * chain.X_before[i];
    axes[i] = {X.translation(), X.linear() * chain.axes[i]};
  }
  X_RF = X * chain.X_6F;
  return axes;
}

/// Angle about the unit axis that turns `from` into `to`, both perpendicular to it.
double angle_about(const Vector& axis, const Vector& from, const Vector& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

/// Midpoint of the common perpendicular of two lines, and their distance.
Vector meeting_point(const Line& a, const Line& b, double& distance) {
  const Vector n = a.direction.cross(b.direction), between = b.point - a.point;
  const double s = between.cross(b.direction).dot(n) / n.squaredNorm();
  const double t = between.cross(a.direction).dot(n) / n.squaredNorm();
  const Vector on_a = a.point + s * a.direction, on_b = b.point + t * b.direction;
  distance = (on_a - on_b).norm();
  return 0.5 * (on_a + on_b);
}

double distance_to(const Line& line, const Vector& point) { return line.direction.cross(point - line.point).norm(); }

/// What keeps an arm from having the closed form; never leaves this file.
struct NoOpw {
  std::string why;
};

class OpwFinder {
 public:
  explicit OpwFinder(const SerialChain& chain) : axes_(axes_in_base(chain, X_RF_)) {}

  /// Throws NoOpw.
  OpwParameters find() {
    check_directions();
    find_wrist();
    find_base();
    find_elbow();
    find_end();
    return opw_;
  }

 private:
  [[noreturn]] static void fail(const std::string& what) { throw NoOpw{what}; }
  void perpendicular(int i, int j) const {
    if (std::abs(axes_[i].direction.dot(axes_[j].direction)) > kAngleTolerance)
      fail("axes of joints " + std::to_string(i + 1) + " and " + std::to_string(j + 1) + " are not perpendicular");
  }

  void check_directions() const {
    perpendicular(0, 1);
    perpendicular(2, 3);
    perpendicular(3, 4);
    perpendicular(4, 5);
    if (axes_[1].direction.cross(axes_[2].direction).norm() > kAngleTolerance)
      fail("axes of joints 2 and 3 are not parallel");
  }

  void find_wrist() {
    double gap = 0;
    wrist_ = meeting_point(axes_[3], axes_[4], gap);
    gap = std::max(gap, distance_to(axes_[5], wrist_));
    if (gap > kLengthTolerance)
      fail("axes of joints 4, 5 and 6 miss one common point by " + std::to_string(gap * 1000) + " mm");
  }

  void find_base() {
    const Vector u1 = axes_[0].direction, u2 = axes_[1].direction;
    opw_.sign[0] = u1.z() < 0 ? -1 : 1;
    z_ = opw_.sign[0] * u1;
    const Vector foot = axes_[0].point - z_ * z_.dot(axes_[0].point);  // joint 1's axis at the height of R's origin
    // Of the two directions of joint 2 the one that puts it in front of joint 1 is taken.
    y_ = (u2 - z_ * z_.dot(u2)).normalized();
    if (y_.cross(z_).dot(axes_[1].point - foot) < -kLengthTolerance) y_ = -y_;
    x_ = y_.cross(z_);
    opw_.sign[1] = y_.dot(u2) > 0 ? 1 : -1;
    opw_.sign[2] = y_.dot(axes_[2].direction) > 0 ? 1 : -1;
    opw_.X_RO.linear() << x_, y_, z_;
    opw_.X_RO.translation() = foot;
    shoulder_ = axes_[1].point - foot;
    elbow_ = axes_[2].point - foot;
    wrist_ -= foot;
    opw_.a1 = x_.dot(shoulder_);
    opw_.c1 = z_.dot(shoulder_);
    opw_.b = y_.dot(wrist_);
  }

  /// Angle about y from z.
  double lean(const Vector& v) const { return std::atan2(x_.dot(v), z_.dot(v)); }
  Vector in_plane(const Vector& v) const { return v - y_ * y_.dot(v); }

  void find_elbow() {
    const Vector upper = in_plane(elbow_ - shoulder_), fore = in_plane(wrist_ - elbow_);
    opw_.c2 = upper.norm();
    opw_.sign[3] = axes_[3].direction.dot(fore) < 0 ? -1 : 1;
    forearm_ = in_plane(opw_.sign[3] * axes_[3].direction).normalized();
    opw_.c3 = forearm_.dot(fore);
    opw_.a2 = y_.cross(forearm_).dot(fore);
    if (opw_.c2 < 1e-3 || opw_.c3 < 1e-3) fail("the upper arm or the forearm has no length");
    opw_.offset[1] = -lean(upper);
    opw_.offset[2] = -(lean(forearm_) - lean(upper));
  }

  void find_end() {
    // Joint 5's direction: of the two the one that lies nearer to the y axis carried along by joints 1 to 3.
    opw_.sign[4] = axes_[4].direction.dot(y_) < -kAngleTolerance ? -1 : 1;
    const Vector u5 = opw_.sign[4] * axes_[4].direction;
    opw_.offset[3] = -angle_about(forearm_, y_, u5);
    const Vector p_tip = X_RF_.translation() - opw_.X_RO.translation() - wrist_;
    opw_.sign[5] = axes_[5].direction.dot(p_tip) < 0 ? -1 : 1;
    const Vector u6 = opw_.sign[5] * axes_[5].direction;
    opw_.c4 = u6.dot(p_tip);
    opw_.offset[4] = -angle_about(u5, forearm_, u6);
    opw_.X_EF = (opw_.X_RO * opw_forward(opw_, to_opw(opw_, Vector6d::Zero()))).inverse() * X_RF_;
  }

  Pose X_RF_ = Pose::Identity();
  std::array<Line, 6> axes_;
  Vector x_, y_, z_, shoulder_, elbow_, wrist_, forearm_;
  OpwParameters opw_;
};

Eigen::Matrix3d turn_z(double angle) { return Eigen::AngleAxisd(angle, Vector::UnitZ()).toRotationMatrix(); }
Eigen::Matrix3d turn_y(double angle) { return Eigen::AngleAxisd(angle, Vector::UnitY()).toRotationMatrix(); }

}  // namespace

std::optional<OpwParameters> find_opw(const SerialChain& chain, std::string& why_not) {
  try {
    return OpwFinder(chain).find();
  } catch (const NoOpw& no) {
    why_not = no.why;
    return std::nullopt;
  }
}

Pose opw_forward(const OpwParameters& opw, const Vector6d& q) {
  const double lean = q[1] + q[2];
  const Vector p_arm(opw.c2 * std::sin(q[1]) + opw.a2 * std::cos(lean) + opw.c3 * std::sin(lean) + opw.a1, opw.b,
                     opw.c2 * std::cos(q[1]) - opw.a2 * std::sin(lean) + opw.c3 * std::cos(lean) + opw.c1);
  const Eigen::Matrix3d R = turn_z(q[0]) * turn_y(lean) * turn_z(q[3]) * turn_y(q[4]) * turn_z(q[5]);
  return pose_from(R, turn_z(q[0]) * p_arm + opw.c4 * R.col(2));
}

Vector6d to_opw(const OpwParameters& opw, const Vector6d& q) {
  Vector6d out;
  for (int i = 0; i < 6; ++i) out[i] = opw.sign[i] * q[i] - opw.offset[i];
  return out;
}

Vector6d from_opw(const OpwParameters& opw, const Vector6d& q_opw) {
  Vector6d out;
  for (int i = 0; i < 6; ++i) out[i] = opw.sign[i] * (q_opw[i] + opw.offset[i]);
  return out;
}

}  // namespace binpick

#include "robot/joint_path.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace binpick {
namespace {

constexpr int kCornerPieces = 64;
constexpr double kStep = 0.01;  // s at full joint speed, sampling of the way

/// Lengths in seconds: what the way would take if each joint had its full speed to itself.
double length_of(const Vector6d& way, const Vector6d& speed) { return way.cwiseQuotient(speed).norm(); }

/// The points as a fine polyline with its corners cut.
std::vector<Vector6d> rounded(const std::vector<Vector6d>& points) {
  std::vector<Vector6d> fine = {points.front()};
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vector6d begin = (points[i - 1] + points[i]) / 2, end = (points[i] + points[i + 1]) / 2;
    for (int k = 0; k <= kCornerPieces; ++k) {
      const double s = static_cast<double>(k) / kCornerPieces;
      fine.push_back((1 - s) * (1 - s) * begin + 2 * s * (1 - s) * points[i] + s * s * end);
    }
  }
  fine.push_back(points.back());
  return fine;
}

/// The polyline at equal steps of its length.
std::vector<Vector6d> evenly(const std::vector<Vector6d>& fine, const Vector6d& speed, double& step) {
  std::vector<double> at = {0};
  for (std::size_t i = 1; i < fine.size(); ++i) at.push_back(at.back() + length_of(fine[i] - fine[i - 1], speed));
  const int count = std::max(8, static_cast<int>(std::ceil(at.back() / kStep)));
  step = at.back() / count;
  std::vector<Vector6d> even = {fine.front()};
  std::size_t i = 1;
  for (int k = 1; k < count; ++k) {
    while (at[i] < k * step) ++i;
    const double share = (k * step - at[i - 1]) / (at[i] - at[i - 1]);
    even.push_back((1 - share) * fine[i - 1] + share * fine[i]);
  }
  even.push_back(fine.back());
  return even;
}

/// What one step of the way allows: qdot = q' sdot and qddot = q' sddot + q'' sdot^2. Bends may take half of the
/// acceleration, so that the other half is always left to brake.
struct StepLimit {
  double fastest2 = 1e18;  ///< of sdot^2
  Vector6d slope = Vector6d::Zero(), bend = Vector6d::Zero();

  double acceleration(const Vector6d& most, double speed2) const {
    double least = 1e18;
    for (int i = 0; i < 6; ++i)
      if (slope[i] > 0) least = std::min(least, (most[i] - bend[i] * speed2) / slope[i]);
    return least;
  }
};

/// Limits of the steps between points k and k + 1.
std::vector<StepLimit> step_limits(const std::vector<Vector6d>& path, double ds, const Vector6d& speed,
                                   const Vector6d& acceleration) {
  std::vector<StepLimit> limits(path.size() - 1);
  for (std::size_t k = 0; k < limits.size(); ++k) {
    StepLimit& limit = limits[k];
    limit.slope = (path[k + 1] - path[k]).cwiseAbs() / ds;
    const auto bend_at = [&](std::size_t j) {
      if (j == 0 || j + 1 >= path.size()) return Vector6d(Vector6d::Zero());
      return Vector6d((path[j + 1] - 2 * path[j] + path[j - 1]).cwiseAbs() / (ds * ds));
    };
    limit.bend = bend_at(k).cwiseMax(bend_at(k + 1));
    for (int i = 0; i < 6; ++i) {
      if (limit.slope[i] > 0) limit.fastest2 = std::min(limit.fastest2, std::pow(speed[i] / limit.slope[i], 2));
      if (limit.bend[i] > 0) limit.fastest2 = std::min(limit.fastest2, 0.5 * acceleration[i] / limit.bend[i]);
    }
  }
  return limits;
}

/// sdot^2 at every point: forwards no quicker than the joints can speed up, backwards no quicker than they can brake.
std::vector<double> speeds2(const std::vector<StepLimit>& steps, double ds, const Vector6d& acceleration) {
  std::vector<double> v2(steps.size() + 1, 0);
  for (std::size_t k = 1; k < steps.size(); ++k) v2[k] = std::min(steps[k - 1].fastest2, steps[k].fastest2);
  for (std::size_t k = 0; k < steps.size(); ++k)
    v2[k + 1] = std::min(v2[k + 1], v2[k] + 2 * ds * steps[k].acceleration(acceleration, v2[k]));
  for (std::size_t k = steps.size(); k-- > 0;)
    v2[k] = std::min(v2[k], v2[k + 1] + 2 * ds * steps[k].acceleration(acceleration, v2[k + 1]));
  return v2;
}

}  // namespace

JointTrajectory joint_path(const Arm& arm, const std::vector<Vector6d>& points, const MotionLimits& limits) {
  BP_CHECK(points.size() >= 2, "a way has two ends");
  if (points.size() == 2) return joint_move(arm, points[0], points[1], limits);
  if (std::all_of(points.begin(), points.end(), [&](const Vector6d& q) { return q == points[0]; }))
    return {{0}, {points[0]}};
  Vector6d speed, acceleration;
  for (int i = 0; i < 6; ++i) {
    const double full = arm.limits()[static_cast<std::size_t>(i)].speed;
    speed[i] = full * limits.speed_override;
    acceleration[i] = full / limits.acceleration_time;
  }
  double ds = 0;
  JointTrajectory out;
  out.q = evenly(rounded(points), speed, ds);
  const std::vector<double> v2 = speeds2(step_limits(out.q, ds, speed, acceleration), ds, acceleration);
  out.times = {0};
  for (std::size_t k = 1; k < out.q.size(); ++k)
    out.times.push_back(out.times.back() + 2 * ds / (std::sqrt(v2[k - 1]) + std::sqrt(v2[k])));
  return out;
}

}  // namespace binpick

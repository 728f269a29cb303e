// mssd [m]: maximum symmetry-aware surface distance (BOP challenge): over the symmetries S of the part the least, over
// the vertices x the largest |X_est x - X_true S x|. Hull vertices suffice, because the distance is convex in x. A
// continuous axis is searched to within kTolerance diameters of the true minimum, by branch and bound: for one vertex
// the squared distance is a + b cos(turn) + c sin(turn), the envelope of these waves lies nowhere below any of them,
// and the least value of one wave over an interval is known in closed form.
#include <cmath>
#include <numbers>
#include <queue>

#include "evaluation/metric.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 1e-6;  // of the diameter

struct Wave {
  double a, b, c;
  double at(double turn) const { return a + b * std::cos(turn) + c * std::sin(turn); }

  /// Least value over [middle - half, middle + half].
  double least(double middle, double half) const {
    const double lowest = std::atan2(-c, -b);
    if (std::abs(std::remainder(lowest - middle, 2 * kPi)) <= half) return a - std::hypot(b, c);
    return std::min(at(middle - half), at(middle + half));
  }
};

struct Peak {
  double value = 0;
  std::size_t wave = 0;
};

Peak highest(const std::vector<Wave>& waves, double turn) {
  const double cosine = std::cos(turn), sine = std::sin(turn);
  Peak peak{-1, 0};
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double value = waves[i].a + waves[i].b * cosine + waves[i].c * sine;
    if (value > peak.value) peak = {value, i};
  }
  return peak;
}

struct Interval {
  double middle, half, lower;
  bool operator<(const Interval& other) const { return lower > other.lower; }  // the queue yields the least first
};

/// The turn at which the highest wave is least; `guess` is tried first.
double least_turn(const std::vector<Wave>& waves, double guess, double tolerance) {
  double best_turn = guess, best = highest(waves, guess).value;
  const auto worth_splitting = [&](double lower) {
    const double goal = std::sqrt(std::max(best, 0.0)) - tolerance;
    return goal > 0 && lower < goal * goal;
  };
  constexpr int kStart = 16;
  std::priority_queue<Interval> open;
  const auto visit = [&](double middle, double half) {
    const Peak peak = highest(waves, middle);
    if (peak.value < best) {
      best = peak.value;
      best_turn = middle;
    }
    const double lower = waves[peak.wave].least(middle, half);
    if (worth_splitting(lower)) open.push({middle, half, lower});
  };
  for (int i = 0; i < kStart; ++i) visit(2 * kPi * (i + 0.5) / kStart, kPi / kStart);
  while (!open.empty() && worth_splitting(open.top().lower)) {
    const Interval wide = open.top();
    open.pop();
    visit(wide.middle - wide.half / 2, wide.half / 2);
    visit(wide.middle + wide.half / 2, wide.half / 2);
  }
  return best_turn;
}

/// Squared distance of X x from the turned x, as a wave of the turn, for every vertex.
std::vector<Wave> waves_of(const Pose& X_PP_est, const std::vector<Eigen::Vector3d>& vertices,
                           const Symmetry::Axis& axis) {
  std::vector<Wave> waves;
  waves.reserve(vertices.size());
  for (const Eigen::Vector3d& x : vertices) {
    const Eigen::Vector3d arm = x - axis.point_P, along = axis.direction_P * axis.direction_P.dot(arm);
    const Eigen::Vector3d radial = arm - along, across = axis.direction_P.cross(arm);
    const Eigen::Vector3d moved = X_PP_est * x - axis.point_P;
    waves.push_back(
        {(moved - along).squaredNorm() + radial.squaredNorm(), -2 * moved.dot(radial), -2 * moved.dot(across)});
  }
  return waves;
}

double largest_distance(const Pose& X_PP_est, const Pose& S, const std::vector<Eigen::Vector3d>& vertices) {
  double squared = 0;
  for (const Eigen::Vector3d& x : vertices) squared = std::max(squared, (X_PP_est * x - S * x).squaredNorm());
  return std::sqrt(squared);
}

class MssdMetric : public Metric {
 public:
  double error(const Pose& X_WP_est, const Pose& X_WP_true, const ScoringModel& model) const override {
    const Symmetry& symmetry = model.symmetry();
    if (symmetry.center_P) {  // turned alike, every point is off by as much as the centre, and no turn does better
      return (X_WP_est * *symmetry.center_P - X_WP_true * *symmetry.center_P).norm();
    }
    const Pose X_PP_est = X_WP_true.inverse() * X_WP_est;
    double least = std::numeric_limits<double>::infinity();
    for (const Pose& member : symmetry.finite) {
      const Pose X_SP_est = member.inverse() * X_PP_est;
      const Pose turn = symmetry.axis ? best_turn(X_SP_est, model) : Pose::Identity();
      least = std::min(least, largest_distance(X_SP_est, turn, model.hull_P()));
    }
    return least;
  }

 private:
  static Pose best_turn(const Pose& X_SP_est, const ScoringModel& model) {
    const Symmetry::Axis& axis = *model.symmetry().axis;
    Symmetry turns_only;
    turns_only.axis = axis;
    const Pose guess = nearest_equivalent(Pose::Identity(), X_SP_est, turns_only);
    const Eigen::Vector3d x = axis.direction_P.unitOrthogonal(), y = axis.direction_P.cross(x);
    const Eigen::Vector3d turned = guess.linear() * x;
    const double turn = least_turn(waves_of(X_SP_est, model.hull_P(), axis), std::atan2(turned.dot(y), turned.dot(x)),
                                   kTolerance * model.diameter());
    Pose S = Pose::Identity();
    S.linear() = Eigen::AngleAxisd(turn, axis.direction_P).toRotationMatrix();
    S.translation() = axis.point_P - S.linear() * axis.point_P;
    return S;
  }
};

}  // namespace

std::unique_ptr<Metric> make_mssd_metric() { return std::make_unique<MssdMetric>(); }

}  // namespace binpick

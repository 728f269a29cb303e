#include "evaluation/metrics_pair.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "evaluation/metric.hpp"

namespace binpick {

/// Projections of an estimate's vertices, and the largest distance of a twin's from them.
class ProjectedVertices {
 public:
  ProjectedVertices(const Pose& X_CP_est, const std::vector<Eigen::Vector3d>& points, const PinholeCamera& camera)
      : camera_(camera) {
    seen_.reserve(points.size());
    for (const Eigen::Vector3d& x : points) {
      const Eigen::Vector3d p_C = X_CP_est * x;
      in_front_ = in_front_ && p_C.z() > 0;
      seen_.push_back({x, camera.project(p_C)});
    }
  }

  bool in_front() const { return in_front_; }

  /// Squared, or what it is known to reach once that is `enough`. The vertex that stopped the last twin is asked first:
  /// the next one is turned a little further.
  double largest_squared(const Pose& X_CP_twin, double enough) {
    const double known = squared(seen_[last_], X_CP_twin);
    if (known >= enough) return known;
    double largest = 0;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const double distance = squared(seen_[i], X_CP_twin);
      if (distance <= largest) continue;
      largest = distance;
      last_ = i;
      if (largest >= enough) break;
    }
    return largest;
  }

  double mean(const Pose& X_CP_twin) const {
    double sum = 0;
    for (const Seen& vertex : seen_) sum += (camera_.project(X_CP_twin * vertex.x) - vertex.at).norm();
    return sum / static_cast<double>(seen_.size());
  }

  /// Only the vertices that can become the farthest while the twin turns on from one pose to the other, or as far back.
  ProjectedVertices near_the_largest(const Pose& X_CP_twin, const Pose& X_CP_turned) const {
    double largest = 0, motion = 0;
    std::vector<double> distance;
    for (const Seen& vertex : seen_) {
      const Eigen::Vector2d there = camera_.project(X_CP_twin * vertex.x);
      distance.push_back((there - vertex.at).norm());
      largest = std::max(largest, distance.back());
      motion = std::max(motion, (camera_.project(X_CP_turned * vertex.x) - there).norm());
    }
    ProjectedVertices few(*this);
    few.seen_.clear();
    few.last_ = 0;
    for (std::size_t i = 0; i < seen_.size(); ++i)
      if (distance[i] >= largest - 4 * motion) few.seen_.push_back(seen_[i]);
    return few;
  }

 private:
  struct Seen {
    Eigen::Vector3d x;  // in P
    Eigen::Vector2d at;
  };
  double squared(const Seen& vertex, const Pose& X_CP_twin) const {
    const Eigen::Vector3d p_C = X_CP_twin * vertex.x;
    return p_C.z() > 0 ? (camera_.project(p_C) - vertex.at).squaredNorm() : kNoLimit;
  }

  PinholeCamera camera_;
  std::vector<Seen> seen_;
  std::size_t last_ = 0;
  bool in_front_ = true;
};

namespace {

/// The member of the list whose twin of the truth is turned most like the estimate: a good first guess.
std::size_t nearest_member(const Pose& X_CP_est, const Pose& X_CP_true, const std::vector<Pose>& group) {
  const Eigen::Matrix3d R = X_CP_true.linear().transpose() * X_CP_est.linear();
  std::size_t nearest = 0;
  double best = -4;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const double trace = R.cwiseProduct(group[k].linear()).sum();
    if (trace > best) {
      best = trace;
      nearest = k;
    }
  }
  return nearest;
}

/// The largest squared distance of a vertex, or what it is known to reach once that is `enough`.
double largest_squared(const Pose& X_CP_est, const Pose& X_CP_twin, const std::vector<Eigen::Vector3d>& points,
                       double enough) {
  const Eigen::Matrix3d R = X_CP_est.linear() - X_CP_twin.linear();
  const Eigen::Vector3d t = X_CP_est.translation() - X_CP_twin.translation();
  double largest = 0;
  for (const Eigen::Vector3d& x : points) {
    largest = std::max(largest, (R * x + t).squaredNorm());
    if (largest >= enough) break;
  }
  return largest;
}

/// Least over the group of what `largest` gives; the best member so far is told to it, so that it may stop early.
template <class Largest>
double least_over(const std::vector<Pose>& group, std::size_t first, double limit, const Largest& largest) {
  double least = std::min(limit, largest(group[first], limit));
  for (const Pose& member : group) least = std::min(least, largest(member, least));
  return least;
}

double root_within(double squared, double limit) {
  const double error = std::sqrt(squared);
  return error < limit ? error : kNoLimit;
}

Pose turn_about(const Symmetry::Axis& axis, double angle) {
  Pose S = Pose::Identity();
  S.linear() = Eigen::AngleAxisd(angle, axis.direction_P).toRotationMatrix();
  S.translation() = axis.point_P - S.linear() * axis.point_P;
  return S;
}

/// Where a function of the turn is least in [-half, half], by golden section.
template <class Value>
double least_turn(double half, const Value& value) {
  constexpr double kGolden = 0.6180339887498949, kNarrow = 1e-9;
  double low = -half, high = half;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = value(a), at_b = value(b);
  while (high - low > kNarrow) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      a = high - kGolden * (high - low), at_a = value(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + kGolden * (high - low), at_b = value(b);
    }
  }
  return (low + high) / 2;
}

/// The best of the toolkit's turns and of the twin nearest in rotation, turned on within a step of the toolkit.
double refined_mspd(const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model, ProjectedVertices& seen,
                    double enough) {
  constexpr double kStep = 2 * M_PI / 315;
  Pose best = nearest_equivalent(X_CP_true, X_CP_est, model.symmetry());
  double least = seen.largest_squared(best, kNoLimit);
  for (const Pose& member : model.toolkit_list()) {
    const Pose twin = X_CP_true * member;
    const double value = seen.largest_squared(twin, least);
    if (value < least) {
      least = value;
      best = twin;
    }
  }
  if (least > 4 * enough) return least;  // a step moves no vertex by half of what the part measures in the image
  const Symmetry::Axis& axis = *model.symmetry().axis;
  ProjectedVertices few = seen.near_the_largest(best, best * turn_about(axis, kStep));
  const double turn =
      least_turn(kStep, [&](double angle) { return few.largest_squared(best * turn_about(axis, angle), kNoLimit); });
  return std::min(least, seen.largest_squared(best * turn_about(axis, turn), kNoLimit));
}

double mspd_of(ProjectedVertices& seen, const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model,
               SymmetrySearch search, double limit_px) {
  if (!seen.in_front()) return kNoLimit;
  const double enough = limit_px * limit_px;
  if (search == SymmetrySearch::kExact && model.symmetry().center_P) {
    const Pose twin = nearest_equivalent(X_CP_true, X_CP_est, model.symmetry());
    return root_within(seen.largest_squared(twin, enough), limit_px);
  }
  if (search == SymmetrySearch::kExact && model.symmetry().axis)
    return root_within(refined_mspd(X_CP_est, X_CP_true, model, seen, enough), limit_px);
  const std::vector<Pose>& list = model.toolkit_list();
  const double least =
      least_over(list, nearest_member(X_CP_est, X_CP_true, list), enough,
                 [&](const Pose& S, double known) { return seen.largest_squared(X_CP_true * S, known); });
  return root_within(least, limit_px);
}

/// Mean distance of true vertices to the nearest estimated one, in the estimate's P.
double adi_error(const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model) {
  const Pose X_PestPtrue = X_CP_est.inverse() * X_CP_true;
  double sum = 0;
  for (const Eigen::Vector3d& x : model.vertices_P()) sum += model.scoring().vertices_P().distance(X_PestPtrue * x);
  return sum / static_cast<double>(model.vertices_P().size());
}

double add_error(const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model) {
  const Eigen::Matrix3d R = X_CP_est.linear() - X_CP_true.linear();
  const Eigen::Vector3d t = X_CP_est.translation() - X_CP_true.translation();
  double sum = 0;
  for (const Eigen::Vector3d& x : model.vertices_P()) sum += (R * x + t).norm();
  return sum / static_cast<double>(model.vertices_P().size());
}

}  // namespace

double mssd_error(const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model, SymmetrySearch search,
                  double limit) {
  if (model.scoring().mssd_lower_bound(X_CP_est, X_CP_true) >= limit) return kNoLimit;
  const bool closed = model.symmetry().axis || model.symmetry().center_P;
  if (search == SymmetrySearch::kExact && closed) {
    const double error = make_metric("mssd")->error(X_CP_est, X_CP_true, model.scoring());
    return error < limit ? error : kNoLimit;
  }
  const std::vector<Pose>& list = model.toolkit_list();
  const double least = least_over(
      list, nearest_member(X_CP_est, X_CP_true, list), limit * limit,
      [&](const Pose& S, double known) { return largest_squared(X_CP_est, X_CP_true * S, model.hull_P(), known); });
  return root_within(least, limit);
}

double mspd_error(const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model, const PinholeCamera& camera,
                  SymmetrySearch search, double limit_px) {
  ProjectedVertices seen(X_CP_est, model.vertices_P(), camera);
  return mspd_of(seen, X_CP_est, X_CP_true, model, search, limit_px);
}

EstimateInImage::EstimateInImage(const Pose& X_CP_est, const FieldModel& model, const PinholeCamera& camera)
    : X_CP_est_(X_CP_est),
      model_(&model),
      seen_(std::make_unique<ProjectedVertices>(X_CP_est, model.vertices_P(), camera)) {}

EstimateInImage::~EstimateInImage() = default;

double EstimateInImage::mspd(const Pose& X_CP_true, SymmetrySearch search, double limit_px) {
  return mspd_of(*seen_, X_CP_est_, X_CP_true, *model_, search, limit_px);
}

PairErrors pair_errors(const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model,
                       const PinholeCamera& camera, SymmetrySearch search) {
  ProjectedVertices seen(X_CP_est, model.vertices_P(), camera);
  PairErrors errors;
  errors.add = add_error(X_CP_est, X_CP_true, model);
  errors.adi = adi_error(X_CP_est, X_CP_true, model);
  errors.mssd = mssd_error(X_CP_est, X_CP_true, model, search);
  errors.mspd_px = mspd_of(seen, X_CP_est, X_CP_true, model, search, kNoLimit);
  errors.projection_px = seen.mean(X_CP_true);
  errors.translation = distance_between(X_CP_est, X_CP_true);
  errors.rotation = angle_between(X_CP_est.linear(), X_CP_true.linear());
  errors.rotation_twin =
      angle_between(X_CP_est.linear(), nearest_equivalent(X_CP_true, X_CP_est, model.symmetry()).linear());
  errors.surface = model.surface().between(X_CP_est, X_CP_true);
  return errors;
}

}  // namespace binpick

#include "evaluation/scoring_model.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "core/mesh_properties.hpp"

namespace binpick {
namespace {

/// Vertices at equal positions once (an STL repeats each of them about six times), in a fixed order.
std::vector<Eigen::Vector3d> distinct(std::vector<Eigen::Vector3d> points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

std::vector<Eigen::Vector3d> strided(const std::vector<Eigen::Vector3d>& points, std::size_t limit) {
  if (points.size() <= limit) return points;
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t k = 0; k < limit; ++k) kept.push_back(points[k * points.size() / limit]);
  return kept;
}

/// Upper bound of |S point - point| over the group.
double spread_of(const Eigen::Vector3d& point_P, const Symmetry& symmetry) {
  if (symmetry.center_P) return 2 * (point_P - *symmetry.center_P).norm();
  double spread = 0;
  for (const Pose& member : symmetry.finite) spread = std::max(spread, (member * point_P - point_P).norm());
  if (symmetry.axis) spread += 2 * symmetry.axis->direction_P.cross(point_P - symmetry.axis->point_P).norm();
  return spread;
}

}  // namespace

ScoringModel::ScoringModel(const Part& part)
    : symmetry_(part.symmetry),
      diameter_(part.diameter),
      box_center_P_(part.box_center_P),
      hull_P_(distinct(hull_vertices(part.mesh_P))),
      vertices_P_(distinct(part.mesh_P.vertices)) {
  BP_CHECK(!hull_P_.empty(), "part " << part.name << " has no vertices");
  mean_points_P_ = strided(distinct(part.mesh_P.vertices), kMeanPoints);
  for (const Eigen::Vector3d& vertex : hull_P_) hull_middle_P_ += vertex / static_cast<double>(hull_P_.size());
  middle_spread_ = spread_of(hull_middle_P_, symmetry_);
}

double ScoringModel::mssd_lower_bound(const Pose& X_WP_est, const Pose& X_WP_true) const {
  // The distance of two placements of a point is convex in the point: inside the hull it is at most that of a vertex.
  return (X_WP_est * hull_middle_P_ - X_WP_true * hull_middle_P_).norm() - middle_spread_;
}

}  // namespace binpick

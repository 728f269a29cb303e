// A part prepared for scoring: everything the metrics need, computed once. Frame P, metres.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/part.hpp"
#include "core/pose.hpp"
#include "core/symmetry.hpp"
#include "evaluation/vertex_tree.hpp"

namespace binpick {

class ScoringModel {
 public:
  explicit ScoringModel(const Part& part);

  const Symmetry& symmetry() const { return symmetry_; }
  double diameter() const { return diameter_; }
  const Eigen::Vector3d& box_center_P() const { return box_center_P_; }

  /// Vertices on the convex hull: the largest distance between two placements of the part is reached at one of them.
  const std::vector<Eigen::Vector3d>& hull_P() const { return hull_P_; }
  /// Distinct vertices for means: all of them, or evenly strided ones when there are more than kMeanPoints.
  const std::vector<Eigen::Vector3d>& mean_points_P() const { return mean_points_P_; }
  /// All distinct vertices.
  const VertexTree& vertices_P() const { return vertices_P_; }

  /// A distance that MSSD cannot fall under, nearly free of cost: how far the middle of the hull has moved, less what
  /// the part's symmetry can explain.
  double mssd_lower_bound(const Pose& X_WP_est, const Pose& X_WP_true) const;

  static constexpr std::size_t kMeanPoints = 500;

 private:
  Symmetry symmetry_;
  double diameter_ = 0;
  Eigen::Vector3d box_center_P_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> hull_P_, mean_points_P_;
  VertexTree vertices_P_;
  Eigen::Vector3d hull_middle_P_ = Eigen::Vector3d::Zero();
  double middle_spread_ = 0;  ///< how far a member of the group can carry the middle
};

}  // namespace binpick

#include "perception/pose_clustering.hpp"

#include <algorithm>

namespace binpick {
namespace {

void sort_by_votes(std::vector<PoseHypothesis>& poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.votes > b.votes; });
}

/// Angle to the nearest symmetric twin, only compared with a limit: axes suffice for parts of revolution.
bool near_in_angle(const Pose& X_1, const Pose& X_2, const Symmetry& symmetry, double limit) {
  if (symmetry.center_P) return true;
  for (const Pose& S : symmetry.finite) {
    if (symmetry.axis) {
      const Eigen::Vector3d a = X_1.linear() * (S.linear() * symmetry.axis->direction_P);
      if (a.dot(X_2.linear() * symmetry.axis->direction_P) > std::cos(limit)) return true;
    } else if (((X_1.linear() * S.linear()).cwiseProduct(X_2.linear())).sum() > 1 + 2 * std::cos(limit)) {
      return true;  // trace of R_1 S R_2^T = 1 + 2 cos(angle)
    }
  }
  return false;
}

}  // namespace

bool same_pose(const Pose& X_1, const Pose& X_2, const Symmetry& symmetry, const SamePose& limits) {
  if ((X_1 * limits.center_P - X_2 * limits.center_P).squaredNorm() > limits.distance * limits.distance) return false;
  return near_in_angle(X_1, X_2, symmetry, limits.angle);
}

std::vector<PoseHypothesis> cluster_poses(std::vector<PoseHypothesis> poses, const Symmetry& symmetry,
                                          const SamePose& limits) {
  sort_by_votes(poses);
  std::vector<PoseHypothesis> clusters;
  for (const PoseHypothesis& pose : poses) {
    const auto same = std::find_if(clusters.begin(), clusters.end(), [&](const PoseHypothesis& c) {
      return same_pose(c.X_CP, pose.X_CP, symmetry, limits);
    });
    if (same == clusters.end()) {
      clusters.push_back(pose);
    } else {
      same->votes += pose.votes;
    }
  }
  sort_by_votes(clusters);
  return clusters;
}

}  // namespace binpick

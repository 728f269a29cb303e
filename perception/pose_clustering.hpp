// Poses that mean the same are one (paper 4.1). Sameness is judged modulo the part's symmetry: distance of the part's
// centre and angle to the nearest symmetric twin. The best pose of a cluster stands for it; poses are not averaged,
// since refinement follows. Nothing is chained: every member is near the cluster's own pose.
#pragma once

#include <vector>

#include "core/symmetry.hpp"
#include "perception/voting.hpp"

namespace binpick {

struct SamePose {
  Eigen::Vector3d center_P = Eigen::Vector3d::Zero();  ///< point whose distance counts, a fixed point of the symmetry
  double distance = 0.01;                              ///< m
  double angle = 0.3;                                  ///< rad
};

/// Are two poses of the part the same within the limits?
bool same_pose(const Pose& X_1, const Pose& X_2, const Symmetry& symmetry, const SamePose& limits);

/// Clusters by falling votes (ties: earlier first); votes of a cluster are summed. Sorted by summed votes.
std::vector<PoseHypothesis> cluster_poses(std::vector<PoseHypothesis> poses, const Symmetry& symmetry,
                                          const SamePose& limits);

}  // namespace binpick

// The search for one kind of part in a scene: points, votes, clusters (part_refinement goes on from there). Frame C for
// poses, P for the model; metres.
#pragma once

#include <vector>

#include "perception/pose_clustering.hpp"
#include "perception/ppf_settings.hpp"
#include "perception/prepared_part.hpp"
#include "perception/scene.hpp"

namespace binpick {

/// The wanted points of a scene on the part's voxel grid (paper 3.1), and its oriented edge points.
struct ScenePoints {
  PointCloud surface_C, edges_C;
  int threads = 1;
};
ScenePoints scene_points(const Scene& scene, const PreparedPart& part, const PpfSettings& settings);

/// Poses voted for by surface points and by edges, clustered, the best of each kind (paper 4.1).
std::vector<PoseHypothesis> voted_poses(const ScenePoints& points, const PreparedPart& part,
                                        const PpfSettings& settings, VoteRun run = {});

/// When two poses of the part are one; `shrink`: of the configured distance and angle.
SamePose same_place(const PreparedPart& part, const SearchConfig& search, double shrink);

}  // namespace binpick

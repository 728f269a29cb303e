// The search for one kind of part in a scene: points, votes, clusters (part_refinement goes on from there). What a part
// needs for it is prepared once from its CAD. Frame C for poses, P for the model; metres.
#pragma once

#include <vector>

#include "core/part.hpp"
#include "perception/pair_table.hpp"
#include "perception/pose_clustering.hpp"
#include "perception/ppf_settings.hpp"
#include "perception/self_overlap.hpp"

namespace binpick {

struct PreparedPart {
  double diameter = 0;
  double thinnest = 0;
  Symmetry symmetry;
  Eigen::Vector3d center_P = Eigen::Vector3d::Zero();
  PairTable table, edge_table;
  SurfaceModel surface;
  std::vector<SelfOverlap> overlaps;
  std::vector<Vector6d> twists;  ///< of a continuous symmetry
};

PreparedPart prepare_part(const Part& part, const PpfSettings& settings);

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

#include "perception/part_search.hpp"

#include "core/parallel.hpp"
#include "perception/edge_points.hpp"
#include "perception/preprocess.hpp"

namespace binpick {
namespace {

std::vector<PoseHypothesis> clusters_of(std::vector<PoseHypothesis> votes, const PreparedPart& part,
                                        const PpfSettings& settings) {
  std::vector<PoseHypothesis> poses =
      cluster_poses(std::move(votes), part.symmetry, same_place(part, settings.search, 1));
  const auto most = static_cast<std::size_t>(settings.search.clusters);
  if (poses.size() > most) poses.resize(most);
  return poses;
}

}  // namespace

SamePose same_place(const PreparedPart& part, const SearchConfig& search, double shrink) {
  return {part.center_P, shrink * search.cluster_distance * part.diameter, shrink * search.cluster_angle};
}

ScenePoints scene_points(const Scene& scene, const PreparedPart& part, const PpfSettings& settings) {
  const double voxel = settings.preprocess.voxel * part.diameter;
  ScenePoints points;
  points.threads = scene.threads;
  parallel_for(2, scene.threads, [&](std::size_t kind) {
    if (kind == 0) points.surface_C = voxel_grid(scene, voxel);
    if (kind == 1 && settings.search.edges) points.edges_C = scene_edges(scene, voxel);
  });
  return points;
}

std::vector<PoseHypothesis> voted_poses(const ScenePoints& points, const PreparedPart& part,
                                        const PpfSettings& settings, VoteRun run) {
  run.threads = points.threads;
  const auto voted = [&](const PointCloud& points_C, const PairTable& table) {
    return clusters_of(vote(points_C, table, part.diameter, settings.voting, run), part, settings);
  };
  std::vector<PoseHypothesis> poses = voted(points.surface_C, part.table);
  for (PoseHypothesis& pose : voted(points.edges_C, part.edge_table)) poses.push_back(pose);
  return poses;
}

}  // namespace binpick

#include "perception/part_search.hpp"

#include "core/mesh_properties.hpp"
#include "core/parallel.hpp"
#include "perception/edge_points.hpp"
#include "perception/score_calibration.hpp"

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

PreparedPart prepare_part(const Part& part, const PpfSettings& settings) {
  PreparedPart p;
  p.diameter = part.diameter;
  p.symmetry = part.symmetry;
  const Eigen::AlignedBox3d box = bounding_box(part.mesh_P);
  p.center_P = box.center();
  p.thinnest = box.sizes().minCoeff();
  const double voxel = settings.preprocess.voxel * part.diameter;
  const PointCloud visible_P = model_cloud(part.mesh_P, part.diameter, settings.model);
  const PairQuantiser quantiser = settings.voting.quantiser(part.diameter);
  p.table = PairTable(voxel_grid(visible_P, voxel), part.symmetry, quantiser, 0.8 * voxel);
  p.edge_table = PairTable(model_edges(part.mesh_P, visible_P, voxel), part.symmetry, quantiser, 0.8 * voxel);
  p.surface = SurfaceModel(part.mesh_P, 0.02 * part.diameter, 1.2 * settings.icp.gate * part.diameter);
  p.twists = symmetry_twists(part.symmetry);
  p.overlaps = self_overlaps(part.mesh_P, part.symmetry, part.diameter);
  return p;
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

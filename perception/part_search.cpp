#include "perception/part_search.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "core/mesh_properties.hpp"
#include "core/parallel.hpp"
#include "perception/edge_points.hpp"
#include "perception/pose_clustering.hpp"

namespace binpick {
namespace {

SamePose same(const PreparedPart& part, const SearchConfig& search, double shrink) {
  return {part.center_P, shrink * search.cluster_distance * part.diameter, shrink * search.cluster_angle};
}

void sort_best_first(std::vector<PoseHypothesis>& poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.votes > b.votes; });
}

std::vector<PoseHypothesis> clusters_of(std::vector<PoseHypothesis> votes, const PreparedPart& part,
                                        const PpfSettings& settings) {
  std::vector<PoseHypothesis> poses = cluster_poses(std::move(votes), part.symmetry, same(part, settings.search, 1));
  const auto most = static_cast<std::size_t>(settings.search.clusters);
  if (poses.size() > most) poses.resize(most);
  return poses;
}

/// The best, but not all from the same corner of the heap: so many a region, up to the number that is refined.
std::vector<PoseHypothesis> spread_out(const std::vector<PoseHypothesis>& poses, const PreparedPart& part,
                                       const SearchConfig& search) {
  const double edge = 0.5 * part.diameter;
  std::map<std::array<int, 3>, int> used;
  std::vector<PoseHypothesis> kept;
  for (const PoseHypothesis& pose : poses) {
    const Eigen::Array3d c = (pose.X_CP * part.center_P).array() / edge;
    const std::array<int, 3> region = {static_cast<int>(std::floor(c.x())), static_cast<int>(std::floor(c.y())),
                                       static_cast<int>(std::floor(c.z()))};
    if (++used[region] <= search.regional) kept.push_back(pose);
    if (kept.size() == static_cast<std::size_t>(search.refined)) break;
  }
  return kept;
}

/// Coarse ICP, then one pose of each place, best first.
std::vector<PoseHypothesis> coarsely_refined(const Scene& scene, const PreparedPart& part,
                                             const std::vector<PoseHypothesis>& poses, const PpfSettings& settings) {
  std::vector<PoseHypothesis> moved;
  for (const PoseHypothesis& pose : poses) {
    const IcpResult fit = refine_pose(scene, part.surface, pose.X_CP, settings.icp, IcpStage::kCoarse);
    if (fit.points < 6 || !fits_bin(scene, part.surface, fit.X_CP, settings.check)) continue;
    moved.push_back({fit.X_CP, check_rays(scene, part.surface, fit.X_CP, settings.check).score()});
  }
  sort_best_first(moved);
  std::vector<PoseHypothesis> distinct;
  for (const PoseHypothesis& pose : moved) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const PoseHypothesis& d) {
      return same_pose(d.X_CP, pose.X_CP, part.symmetry, same(part, settings.search, 0.5));
    });
    if (!known) distinct.push_back(pose);
    if (distinct.size() == static_cast<std::size_t>(settings.search.finished)) break;
  }
  return distinct;
}

}  // namespace

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

std::vector<PoseHypothesis> verified_poses(const Scene& scene, const PreparedPart& part,
                                           const std::vector<PoseHypothesis>& poses, const PpfSettings& settings) {
  const CheckConfig& check = settings.check;
  const VoxelSet voxels(scene, check.voxel * part.diameter);
  std::vector<PoseHypothesis> kept;
  for (const PoseHypothesis& pose : poses) {
    if (voxel_share(voxels, part.surface, pose.X_CP, check.points) < check.least_voxel_share) continue;
    kept.push_back({pose.X_CP, check_rays(scene, part.surface, pose.X_CP, check, check.rough).score()});
  }
  sort_best_first(kept);
  return spread_out(kept, part, settings.search);
}

std::vector<Candidate> refined_poses(const Scene& scene, const PreparedPart& part,
                                     const std::vector<PoseHypothesis>& poses, const PpfSettings& settings) {
  std::vector<Candidate> out;
  for (const PoseHypothesis& pose : coarsely_refined(scene, part, poses, settings)) {
    Candidate c;
    c.fit = refine_pose(scene, part.surface, pose.X_CP, settings.icp, IcpStage::kFine);
    const double z = (c.fit.X_CP * part.center_P).z();
    if (c.fit.points < 6 || c.fit.mean_deviation > accepted_deviation(scene, z, settings.icp)) continue;
    if (!fits_bin(scene, part.surface, c.fit.X_CP, settings.check)) continue;
    c.check = check_view(scene, part.surface, c.fit.X_CP, settings.check);
    if (accepted(c.check, settings.accept)) out.push_back(std::move(c));
  }
  return out;
}

}  // namespace binpick

#include "tools/bench/peers/peer.hpp"

#include <algorithm>
#include <chrono>

#include "core/error.hpp"
#include "core/mesh_properties.hpp"
#include "perception/model_cloud.hpp"
#include "perception/preprocess.hpp"

namespace binpick {

#ifdef BINPICK_WITH_OPENCV_PEER
std::unique_ptr<PoseEstimator> make_opencv_peer();
#endif
#ifdef BINPICK_WITH_PCL_PEER
std::unique_ptr<PoseEstimator> make_pcl_peer();
#endif

namespace {

class Lap {
 public:
  double seconds() {
    const auto now = std::chrono::steady_clock::now(), before = std::exchange(last_, now);
    return std::chrono::duration<double>(now - before).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// By votes; of several at one place only the best.
std::vector<VotedPose> best_of(std::vector<VotedPose> poses, const Eigen::Vector3d& center_P, double distinct,
                               std::size_t most) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const VotedPose& a, const VotedPose& b) { return a.votes > b.votes; });
  std::vector<VotedPose> kept;
  for (const VotedPose& pose : poses) {
    const Eigen::Vector3d center_C = pose.X_CP * center_P;
    const bool known = std::any_of(
        kept.begin(), kept.end(), [&](const VotedPose& k) { return (k.X_CP * center_P - center_C).norm() < distinct; });
    if (!known && kept.size() < most) kept.push_back(pose);
  }
  return kept;
}

}  // namespace

const std::vector<EstimatorEntry>& peer_registry() {
  static const std::vector<EstimatorEntry> entries = {
#ifdef BINPICK_WITH_OPENCV_PEER
      {"opencv", "OpenCV contrib, surface_matching: ppf_match_3d::PPF3DDetector", make_opencv_peer},
#endif
#ifdef BINPICK_WITH_PCL_PEER
      {"pcl", "PCL: PPFRegistration with PPFHashMapSearch", make_pcl_peer},
#endif
  };
  return entries;
}

void PeerSettings::visit(ConfigVisitor& v) {
  v.field("voxel", voxel, Unit::kNone, "voxel grid of model and scene, of the diameter");
  v.field("cluster_distance", cluster_distance, Unit::kNone,
          "poses of a cluster lie nearer than this, of the diameter");
  v.field("cluster_angle", cluster_angle, Unit::kAngle, "and are turned by less than this");
  v.field("reference_step", reference_step, "every n-th scene point is a reference");
  v.field("best", best, "poses returned, by votes");
  v.field("distinct", distinct, Unit::kNone, "of centres nearer than this only the best is returned, of the diameter");
}

void PeerSettings::validate() const {
  if (!(voxel > 0.005 && voxel < 0.5)) throw SpecError("voxel: must lie between 0.005 and 0.5");
  if (!(cluster_distance > 0) || !(cluster_angle > 0) || !(distinct >= 0))
    throw SpecError("cluster_distance, cluster_angle, distinct: must be positive");
  if (reference_step < 1 || best < 1) throw SpecError("reference_step, best: must be at least 1");
}

void Peer::prepare(std::span<const Part> parts) {
  parts_.clear();
  forget();
  for (const Part& part : parts) {
    const Eigen::AlignedBox3d box = bounding_box(part.mesh_P);
    parts_.push_back({part.diameter, box.sizes().minCoeff(), box.center()});
    const PointCloud visible_P = model_cloud(part.mesh_P, part.diameter, ModelCloudConfig{});
    train(parts_.size() - 1, voxel_grid(visible_P, settings_.voxel * part.diameter), part.diameter);
  }
}

EstimateResult Peer::estimate(const SceneView& view, Seed) const {
  EstimateResult result;
  Lap lap;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const Known& part = parts_[p];
    const Scene scene = make_scene(view, PreprocessConfig{}, NormalsConfig{}, part.thinnest);
    const PointCloud scene_C = voxel_grid(scene, settings_.voxel * part.diameter);
    result.wall.preprocess += lap.seconds();
    std::vector<VotedPose> poses;
    if (scene_C.size() > 1) poses = match(p, scene_C);
    poses = best_of(std::move(poses), part.center_P, settings_.distinct * part.diameter,
                    static_cast<std::size_t>(settings_.best));
    for (const VotedPose& pose : poses) {
      PoseEstimate estimate;
      estimate.part = p;
      estimate.X_CP = pose.X_CP;
      estimate.score = pose.votes / poses.front().votes;
      result.estimates.push_back(estimate);
    }
    result.wall.voting += lap.seconds();
  }
  std::stable_sort(result.estimates.begin(), result.estimates.end(),
                   [](const PoseEstimate& a, const PoseEstimate& b) { return a.score > b.score; });
  result.wall.total = result.wall.preprocess + result.wall.voting;
  result.status = result.estimates.empty() ? EstimateStatus::kNothingFound : EstimateStatus::kFound;
  return result;
}

}  // namespace binpick

// type: paper_ppf. The paper's pipeline (Le Duc Hanh, Khuong Thanh Gia Hieu), section by section:
//   2    CAD -> points visible from six views                              model_cloud, once a part
//   3.1  crop, floor and walls away, normals, voxel grid                   preprocess
//   4    point pair features, 5 mm or 0.05 diameter and 12 degrees         pair_table, once a part
//   4.1  Hough voting over (model point, alpha), clustering                voting, pose_clustering
//   4.2  verification on a voxel grid, then along the rays                 hypothesis_check
//   4.2  ICP on the visible points until the mean deviation is small       icp, with the silhouette
// What the paper leaves open and this adds: parts of revolution vote once, the floor corrects the sensor's disparity,
// refined poses are drawn and checked pixel by pixel, and no two may claim the same place (view_check).
// Deterministic; the seed is not used. Parameters and defaults: the sections of visit().
#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <numbers>

#include "core/check.hpp"
#include "core/error.hpp"
#include "perception/edge_points.hpp"
#include "perception/hypothesis_check.hpp"
#include "perception/icp.hpp"
#include "perception/model_cloud.hpp"
#include "perception/pair_table.hpp"
#include "perception/pose_clustering.hpp"
#include "perception/pose_estimator.hpp"
#include "perception/preprocess.hpp"
#include "perception/view_check.hpp"
#include "perception/voting.hpp"

namespace binpick {
std::unique_ptr<PoseEstimator> make_paper_ppf_estimator();
namespace {

struct SearchConfig {
  int clusters = 400;             // hypotheses that are verified, the best of each region first
  int refined = 150;              // of those, refined coarsely
  int regional = 10;              // of those, at most so many whose centres lie in one region of half a diameter
  int finished = 50;              // of those, refined finely with the silhouette
  double cluster_distance = 0.1;  // of the diameter
  double cluster_angle = 0.4;     // rad
  bool edges = true;              // vote with oriented edge points, too

  void visit(ConfigVisitor& v) {
    v.field("clusters", clusters, "hypotheses of a part that are verified");
    v.field("refined", refined, "of those, refined coarsely");
    v.field("regional", regional, "of those, at most so many in one region of half a diameter");
    v.field("finished", finished, "of those, refined finely");
    v.field("cluster_distance", cluster_distance, Unit::kNone, "poses nearer than this are one, of the diameter");
    v.field("cluster_angle", cluster_angle, Unit::kAngle, "and turned by less than this");
    v.field("edges", edges, "vote with pairs of oriented edge points, beside the paper's surface points");
  }
  void validate() const {
    if (clusters < 1 || refined < 1 || regional < 1 || finished < 1)
      throw SpecError("search.clusters, refined, regional, finished: must be at least 1");
    if (!(cluster_distance > 0 && cluster_distance <= 1))
      throw SpecError("search.cluster_distance: must lie between 0 and 1");
    if (!(cluster_angle > 0 && cluster_angle <= 3.2))
      throw SpecError("search.cluster_angle: must lie between 0 and pi");
  }
};

struct PreparedPart {
  double diameter = 0;
  double thinnest = 0;
  Symmetry symmetry;
  Eigen::Vector3d center_P = Eigen::Vector3d::Zero();
  PairTable table, edge_table;
  SurfaceModel surface;
};

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

class PaperPpfEstimator : public PoseEstimator {
 public:
  void visit(ConfigVisitor& v) override {
    v.section("model", model_, "CAD to visible points (paper 2)");
    v.section("preprocess", preprocess_, "crop, floor, walls, voxel grid (paper 3.1)");
    v.section("normals", normals_, "normals and their agreement (paper eq. 1-3)");
    v.section("voting", voting_, "pair features and Hough voting (paper 4, 4.1)");
    v.section("search", search_, "how many hypotheses go on");
    v.section("check", check_, "hypothesis verification (paper 4.2)");
    v.section("icp", icp_, "refinement on visible points (paper 4.2)");
    v.section("accept", accept_, "what is returned");
  }
  void validate() const override {
    model_.validate(), preprocess_.validate(), normals_.validate(), voting_.validate(), search_.validate();
    check_.validate(), icp_.validate(), accept_.validate();
  }
  void prepare(std::span<const Part> parts) override;
  EstimateResult estimate(const SceneView& view, Seed seed) const override;

 private:
  std::vector<PoseHypothesis> hypotheses(const PreparedPart& part, const PointCloud& points_C,
                                         const PairTable& table) const;
  std::vector<PoseHypothesis> verified(const Scene& scene, const PreparedPart& part,
                                       std::vector<PoseHypothesis> poses) const;
  std::vector<PoseHypothesis> one_region_each(const std::vector<PoseHypothesis>& poses, const PreparedPart& part) const;
  std::vector<Candidate> refined(const Scene& scene, std::size_t index, const std::vector<PoseHypothesis>& poses) const;
  std::vector<PoseHypothesis> coarse(const Scene& scene, const PreparedPart& part,
                                     const std::vector<PoseHypothesis>& poses) const;
  SamePose same(const PreparedPart& part, double shrink) const {
    return {part.center_P, shrink * search_.cluster_distance * part.diameter, shrink * search_.cluster_angle};
  }

  ModelCloudConfig model_;
  PreprocessConfig preprocess_;
  NormalsConfig normals_;
  VotingConfig voting_;
  SearchConfig search_;
  CheckConfig check_;
  IcpConfig icp_;
  AcceptConfig accept_;
  std::vector<PreparedPart> parts_;
};

void PaperPpfEstimator::prepare(std::span<const Part> parts) {
  parts_.clear();
  for (const Part& part : parts) {
    PreparedPart p;
    p.diameter = part.diameter;
    p.symmetry = part.symmetry;
    p.center_P = bounding_box(part.mesh_P).center();
    p.thinnest = bounding_box(part.mesh_P).sizes().minCoeff();
    const double voxel = preprocess_.voxel * part.diameter;
    const PointCloud visible_P = model_cloud(part.mesh_P, part.diameter, model_);
    const PairQuantiser quantiser = voting_.quantiser(part.diameter);
    p.table = PairTable(voxel_grid(visible_P, voxel), part.symmetry, quantiser, 0.8 * voxel);
    p.edge_table = PairTable(model_edges(part.mesh_P, visible_P, voxel), part.symmetry, quantiser, 0.8 * voxel);
    p.surface = SurfaceModel(part.mesh_P, 0.02 * part.diameter, 1.2 * icp_.gate * part.diameter);
    parts_.push_back(std::move(p));
  }
}

/// Votes of one kind of points, clustered; the best of them (paper 4.1).
std::vector<PoseHypothesis> PaperPpfEstimator::hypotheses(const PreparedPart& part, const PointCloud& points_C,
                                                          const PairTable& table) const {
  std::vector<PoseHypothesis> poses =
      cluster_poses(vote(points_C, table, part.diameter, voting_), part.symmetry, same(part, 1));
  if (poses.size() > static_cast<std::size_t>(search_.clusters))
    poses.resize(static_cast<std::size_t>(search_.clusters));
  return poses;
}

/// The hypotheses that the scene bears out best, checked on the voxel grid and along the rays (paper 4.2).
std::vector<PoseHypothesis> PaperPpfEstimator::verified(const Scene& scene, const PreparedPart& part,
                                                        std::vector<PoseHypothesis> poses) const {
  const VoxelSet voxels(scene, check_.voxel * part.diameter);
  std::vector<PoseHypothesis> kept;
  for (PoseHypothesis& pose : poses) {
    if (voxel_share(voxels, part.surface, pose.X_CP, check_.points) < check_.least_voxel_share) continue;
    pose.votes = check_rays(scene, part.surface, pose.X_CP, check_, check_.rough).score();
    kept.push_back(pose);
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.votes > b.votes; });
  return one_region_each(kept, part);
}

/// The best, but not all from the same heap corner: so many a region, up to the number that is refined.
std::vector<PoseHypothesis> PaperPpfEstimator::one_region_each(const std::vector<PoseHypothesis>& poses,
                                                               const PreparedPart& part) const {
  const double edge = 0.5 * part.diameter;
  std::map<std::array<int, 3>, int> used;
  std::vector<PoseHypothesis> kept;
  for (const PoseHypothesis& pose : poses) {
    const Eigen::Array3d c = (pose.X_CP * part.center_P).array() / edge;
    const std::array<int, 3> region = {static_cast<int>(std::floor(c.x())), static_cast<int>(std::floor(c.y())),
                                       static_cast<int>(std::floor(c.z()))};
    if (++used[region] <= search_.regional) kept.push_back(pose);
    if (kept.size() == static_cast<std::size_t>(search_.refined)) break;
  }
  return kept;
}

/// Coarse ICP of the best, then one of each place.
std::vector<PoseHypothesis> PaperPpfEstimator::coarse(const Scene& scene, const PreparedPart& part,
                                                      const std::vector<PoseHypothesis>& poses) const {
  std::vector<PoseHypothesis> out;
  for (const PoseHypothesis& pose : poses) {
    const IcpResult fit = refine_pose(scene, part.surface, pose.X_CP, icp_, IcpStage::kCoarse);
    if (fit.points < 6 || !fits_bin(scene, part.surface, fit.X_CP, check_)) continue;
    out.push_back({fit.X_CP, check_rays(scene, part.surface, fit.X_CP, check_).score()});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.votes > b.votes; });
  std::vector<PoseHypothesis> distinct;
  for (const PoseHypothesis& pose : out) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const PoseHypothesis& d) {
      return same_pose(d.X_CP, pose.X_CP, part.symmetry, same(part, 0.5));
    });
    if (!known) distinct.push_back(pose);
  }
  return distinct;
}

std::vector<Candidate> PaperPpfEstimator::refined(const Scene& scene, std::size_t index,
                                                  const std::vector<PoseHypothesis>& poses) const {
  const PreparedPart& part = parts_[index];
  std::vector<PoseHypothesis> distinct = coarse(scene, part, poses);
  if (distinct.size() > static_cast<std::size_t>(search_.finished))
    distinct.resize(static_cast<std::size_t>(search_.finished));
  std::vector<Candidate> out;
  for (const PoseHypothesis& pose : distinct) {
    Candidate c{index, refine_pose(scene, part.surface, pose.X_CP, icp_, IcpStage::kFine), {}};
    if (c.fit.points < 6 || c.fit.mean_deviation > accepted_deviation(scene, c.fit.X_CP.translation().z(), icp_))
      continue;
    if (!fits_bin(scene, part.surface, c.fit.X_CP, check_)) continue;
    c.check = check_view(scene, part.surface, c.fit.X_CP, check_);
    if (accepted(c.check, accept_)) out.push_back(std::move(c));
  }
  return out;
}

/// A turn that changes nothing cannot be known: uniform over a whole turn, about the symmetry's axis (twist in P).
Matrix6d unknowable(const Symmetry& symmetry) {
  Matrix6d out = Matrix6d::Zero();
  const auto add = [&](const Eigen::Vector3d& point_P, const Eigen::Vector3d& direction_P) {
    Vector6d twist;
    twist << point_P.cross(direction_P), direction_P;
    out += std::numbers::pi * std::numbers::pi / 3 * twist * twist.transpose();
  };
  if (symmetry.axis) add(symmetry.axis->point_P, symmetry.axis->direction_P.normalized());
  for (int k = 0; k < 3 && symmetry.center_P; ++k) add(*symmetry.center_P, Eigen::Vector3d::Unit(k));
  return out;
}

PoseEstimate to_estimate(const Candidate& c, const Symmetry& symmetry) {
  PoseEstimate e;
  e.part = c.part;
  e.X_CP = c.fit.X_CP;
  e.score = std::clamp(c.check.score(), 0.0, 1.0);
  e.fit_rms = c.fit.rms;
  const int judged = c.check.inliers + c.check.through + c.check.off + c.check.unknown;
  e.inlier_fraction = judged > 0 ? static_cast<double>(c.check.inliers) / judged : 0;
  e.covariance = c.fit.covariance + unknowable(symmetry);
  return e;
}

EstimateResult PaperPpfEstimator::estimate(const SceneView& view, Seed) const {
  BP_CHECK(!parts_.empty(), "prepare() comes first");
  EstimateResult result;
  Stopwatch total, stage;
  double thinnest = parts_.front().thinnest;
  for (const PreparedPart& p : parts_) thinnest = std::min(thinnest, p.thinnest);
  const Scene scene = make_scene(view, preprocess_, normals_, thinnest);
  result.wall.preprocess = stage.lap();
  std::vector<Candidate> candidates;
  std::vector<const SurfaceModel*> models;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const PreparedPart& part = parts_[i];
    models.push_back(&part.surface);
    stage.lap();
    const PointCloud points_C = voxel_grid(scene, preprocess_.voxel * part.diameter);
    const PointCloud edges_C = scene_edges(scene, preprocess_.voxel * part.diameter);
    result.wall.preprocess += stage.lap();
    std::vector<PoseHypothesis> poses = hypotheses(part, points_C, part.table);
    if (search_.edges)
      for (PoseHypothesis& pose : hypotheses(part, edges_C, part.edge_table)) poses.push_back(std::move(pose));
    result.wall.voting += stage.lap();
    poses = verified(scene, part, std::move(poses));
    result.wall.verification += stage.lap();
    for (Candidate& c : refined(scene, i, poses)) candidates.push_back(std::move(c));
    result.wall.icp += stage.lap();
  }
  for (const Candidate& c : resolve_conflicts(std::move(candidates), models, scene, accept_))
    result.estimates.push_back(to_estimate(c, parts_[c.part].symmetry));
  result.wall.verification += stage.lap();
  result.status = result.estimates.empty() ? EstimateStatus::kNothingFound : EstimateStatus::kFound;
  result.wall.total = total.lap();
  return result;
}

}  // namespace

std::unique_ptr<PoseEstimator> make_paper_ppf_estimator() { return std::make_unique<PaperPpfEstimator>(); }

}  // namespace binpick

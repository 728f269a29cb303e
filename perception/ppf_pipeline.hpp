// The pipeline behind `type: ppf` and `type: paper_ppf`: one order of stages, two sets of defaults.
//   scene     crop, floor and walls, normals, voxel grid                   preprocess
//   votes     pairs of surface points and of oriented edge points          part_search (pair_table, voting, clustering)
//   check     voxel grid, then along the rays                              part_refinement (hypothesis_check)
//   refine    ICP on the visible points, with the silhouette               part_refinement (icp, view_check)
//   settle    no two poses may claim the same place                        view_check
//   rivals    poses the view cannot tell apart are marked and come last    rival_poses (self_overlap)
// and a second search looks at what is still unexplained. Frame C, metres. The answer is a function of view and
// settings alone: neither the seed nor the number of threads changes it.
#pragma once

#include "perception/part_refinement.hpp"
#include "perception/pose_estimator.hpp"
#include "perception/score_calibration.hpp"

namespace binpick {

class PpfEstimator : public PoseEstimator {
 public:
  explicit PpfEstimator(PpfSettings defaults) : settings_(std::move(defaults)) {}
  void visit(ConfigVisitor& v) override { settings_.visit(v); }
  void validate() const override { settings_.validate(); }
  /// As prepare_with() the cache that the environment names.
  void prepare(std::span<const Part> parts) override;
  void prepare_with(std::span<const Part> parts, const DiskCache& cache);
  EstimateResult estimate(const SceneView& view, Seed seed) const override;
  /// The same, and beside each estimate what its score was made of.
  EstimateResult estimate_with(const SceneView& view, std::vector<ScoreFeatures>* features) const;
  std::size_t table_bytes() const override {
    std::size_t bytes = 0;
    for (const PreparedPart& part : parts_) bytes += part.table.bytes() + part.edge_table.bytes();
    return bytes;
  }

  const std::vector<PreparedPart>& prepared() const { return parts_; }

 private:
  std::vector<Candidate> search(const Scene& scene, StageTimes& wall) const;
  bool settle(const Scene& scene, std::vector<Candidate>& standing) const;
  std::vector<Candidate> stand(const Scene& scene, std::vector<Candidate> candidates) const;
  std::vector<Candidate> all_poses(const Scene& scene, StageTimes& wall) const;
  std::vector<Candidate> first_poses(const Scene& scene, StageTimes& wall) const;  ///< search.enough
  bool refine_in_waves(const Scene& scene, std::size_t part, const std::vector<PoseHypothesis>& poses,
                       std::vector<Candidate>& standing) const;
  void judge(const Scene& scene, std::vector<Candidate>& standing) const;
  std::vector<Candidate> scored(const Scene& scene, std::vector<Candidate> standing) const;
  std::string take_back(std::vector<Candidate>& poses) const;
  bool enough(const std::vector<Candidate>& standing) const;
  PpfSettings settings_;
  std::vector<PreparedPart> parts_;
};

}  // namespace binpick

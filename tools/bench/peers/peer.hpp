// Open point-pair-feature matchers as peers of `binpick bench perception`: OpenCV's ppf_match_3d and PCL's
// PPFRegistration, in the same process and on the same looks. They are part of the benchmark only. Each is given what
// serves it best: our crop, floor and walls removed, our normals, and clouds on a voxel grid already (OpenCV's own
// sampler counts cells per axis and makes them flat on flat parts; neither library takes a bin away). Neither verifies
// what it votes for, so the best poses by votes are taken, each place once. Frame C, metres.
#pragma once

#include <vector>

#include "core/point_cloud.hpp"
#include "perception/pose_estimator.hpp"

namespace binpick {

/// `opencv` and `pcl`, as far as they were found when this was built.
const std::vector<EstimatorEntry>& peer_registry();

/// What both peers share.
struct PeerSettings {
  double voxel = 0.05;            ///< of the diameter
  double cluster_distance = 0.1;  ///< of the diameter
  double cluster_angle = 0.35;    ///< rad
  int reference_step = 5;         ///< every n-th scene point is a reference
  int best = 10;                  ///< poses returned; neither peer can tell a good one from a bad one
  double distinct = 0.1;          ///< of the diameter: of centres nearer than this only the best is returned

  void visit(ConfigVisitor& v);
  void validate() const;
};

struct VotedPose {
  Pose X_CP;
  double votes = 0;
};

/// Base of both: prepares the clouds, keeps the best of what was voted for.
class Peer : public PoseEstimator {
 public:
  explicit Peer(const PeerSettings& defaults) : settings_(defaults) {}
  void visit(ConfigVisitor& v) override { settings_.visit(v); }
  void validate() const override { settings_.validate(); }
  void prepare(std::span<const Part> parts) override;
  EstimateResult estimate(const SceneView& view, Seed seed) const override;

 protected:
  /// `model_P` with outward normals, on the voxel grid; `diameter` in m.
  virtual void train(std::size_t part, const PointCloud& model_P, double diameter) = 0;
  virtual void forget() = 0;
  /// `scene_C` with normals towards the camera, on the voxel grid.
  virtual std::vector<VotedPose> match(std::size_t part, const PointCloud& scene_C) const = 0;
  const PeerSettings& settings() const { return settings_; }

 private:
  struct Known {
    double diameter = 0, thinnest = 0;
    Eigen::Vector3d center_P = Eigen::Vector3d::Zero();
  };
  PeerSettings settings_;
  std::vector<Known> parts_;
};

}  // namespace binpick

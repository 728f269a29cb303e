// opencv: ppf_match_3d::PPF3DDetector of OpenCV contrib. Its sampler lays a fixed number of cells along each axis of
// the cloud's box: the model is given one cell a voxel along its longest side; the scene half a voxel, so that the grid
// it is on already survives. The step of the pair's length is the model's sampling step times the box's diagonal,
// whatever else one asks for. Poses whose rotation *angles* and places are alike are clustered; the place's limit is an
// absolute length and has to be set (by default it is the relative sampling step: with metres everything within 50 mm
// is one pose). Its ICP is not used: it fits the whole model and carries right poses away.
#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/surface_matching.hpp>

#include "tools/bench/peers/peer.hpp"

namespace binpick {
std::unique_ptr<PoseEstimator> make_opencv_peer();
namespace {

cv::Mat matrix_of(const PointCloud& cloud) {
  cv::Mat rows(static_cast<int>(cloud.size()), 6, CV_32F);
  for (int i = 0; i < rows.rows; ++i)
    for (int k = 0; k < 3; ++k) {
      rows.at<float>(i, k) = static_cast<float>(cloud.points[static_cast<std::size_t>(i)][k]);
      rows.at<float>(i, 3 + k) = static_cast<float>(cloud.normals[static_cast<std::size_t>(i)][k]);
    }
  return rows;
}

double longest_side(const PointCloud& cloud) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : cloud.points) box.extend(p);
  return box.sizes().maxCoeff();
}

/// The rotation nearest to what the clustering averaged.
Pose rigid(const cv::Matx44d& matrix) {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) R(row, column) = matrix(row, column);
    t[row] = matrix(row, 3);
  }
  return pose_from(Eigen::Quaterniond(R).normalized().toRotationMatrix(), t);
}

/// Best of a dozen sets on three heaps of bearings and of brackets, seeds 100 to 102.
PeerSettings opencv_defaults() {
  PeerSettings settings;
  settings.cluster_distance = 0.15;
  settings.distinct = 0.2;
  return settings;
}

class OpencvPeer : public Peer {
 public:
  OpencvPeer() : Peer(opencv_defaults()) {}

 private:
  struct Model {
    mutable cv::ppf_match_3d::PPF3DDetector detector;  // match() is not const, and changes nothing but scratch
    double voxel = 0;
  };

  void forget() override { models_.clear(); }
  void train(std::size_t, const PointCloud& model_P, double diameter) override {
    const double step = settings().voxel * diameter / longest_side(model_P);
    models_.push_back(std::make_unique<Model>());
    Model& model = *models_.back();
    model.detector = cv::ppf_match_3d::PPF3DDetector(step, step, 30);
    model.detector.setSearchParams(settings().cluster_distance * diameter, settings().cluster_angle, true);
    model.detector.trainModel(matrix_of(model_P));
    model.voxel = settings().voxel * diameter;
  }
  std::vector<VotedPose> match(std::size_t part, const PointCloud& scene_C) const override {
    const Model& model = *models_[part];
    std::vector<cv::ppf_match_3d::Pose3DPtr> found;
    model.detector.match(matrix_of(scene_C), found, 1.0 / settings().reference_step,
                         0.5 * model.voxel / longest_side(scene_C));
    std::vector<VotedPose> poses;
    for (const auto& pose : found)
      if (rigid(pose->pose).matrix().allFinite())
        poses.push_back({rigid(pose->pose), static_cast<double>(pose->numVotes)});
    return poses;
  }

  std::vector<std::unique_ptr<Model>> models_;
};

}  // namespace

std::unique_ptr<PoseEstimator> make_opencv_peer() { return std::make_unique<OpencvPeer>(); }

}  // namespace binpick

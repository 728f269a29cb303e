// pcl: PPFRegistration of PCL with its PPFHashMapSearch. PCL 1.13 returns one pose: its clusterPoses is specialised
// here for this point type, with the same rule of clustering, and keeps every cluster. Its accumulator is sized by
// rounding down and written one past its end when alpha is pi, unless the angle step is chosen so that both roundings
// agree.
#include <pcl/console/print.h>
#include <pcl/features/ppf.h>
#include <pcl/point_types.h>
#include <pcl/registration/ppf_registration.h>
#include <pcl/features/impl/ppf.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.hpp"
#include "tools/bench/peers/peer.hpp"

namespace binpick {
namespace {

using Point = pcl::PointNormal;
using Registration = pcl::PPFRegistration<Point, Point>;

struct Cluster {
  Eigen::Affine3f front;
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
  Eigen::Vector4f turn = Eigen::Vector4f::Zero();
  unsigned int poses = 0, votes = 0;
};

thread_local std::vector<Cluster> kept_clusters;

bool alike(const Eigen::Affine3f& a, const Eigen::Affine3f& b, float distance, float angle) {
  return (a.translation() - b.translation()).norm() < distance &&
         Eigen::AngleAxisf(a.linear().transpose() * b.linear()).angle() < angle;
}

void add(Cluster& cluster, const Eigen::Affine3f& pose, unsigned int votes) {
  Eigen::Vector4f q = Eigen::Quaternionf(pose.linear()).coeffs();
  if (q.dot(cluster.turn) < 0) q = -q;  // q and -q are one rotation
  cluster.turn += q;
  cluster.place += pose.translation();
  cluster.votes += votes;
  ++cluster.poses;
}

}  // namespace
}  // namespace binpick

namespace pcl {

template <>
void PPFRegistration<PointNormal, PointNormal>::clusterPoses(PoseWithVotesList& poses, PoseWithVotesList& result) {
  std::vector<binpick::Cluster>& clusters = binpick::kept_clusters;
  clusters.clear();
  std::sort(poses.begin(), poses.end(), poseWithVotesCompareFunction);
  for (const PoseWithVotes& pose : poses) {
    auto cluster = std::find_if(clusters.begin(), clusters.end(), [&](const binpick::Cluster& c) {
      return binpick::alike(c.front, pose.pose, clustering_position_diff_threshold_,
                            clustering_rotation_diff_threshold_);
    });
    if (cluster == clusters.end()) {
      clusters.emplace_back();
      clusters.back().front = pose.pose;
      cluster = clusters.end() - 1;
    }
    binpick::add(*cluster, pose.pose, pose.votes);
  }
  unsigned int none = 0;
  Eigen::Affine3f unmoved = Eigen::Affine3f::Identity();
  result.assign(1, PoseWithVotes(unmoved, none));  // the caller reads the first
}

}  // namespace pcl

namespace binpick {
std::unique_ptr<PoseEstimator> make_pcl_peer();
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kWishedStep = 12 * std::numbers::pi / 180;

/// The step near 12 degrees with which the accumulator's size and its last index agree.
float safe_angle_step() {
  const double last = std::nextafter(std::numbers::pi_v<float>, 0.0f) + std::numbers::pi;  // largest alpha, shifted
  for (int bins = 30; bins < 60; ++bins) {
    float step = static_cast<float>(kTurn / bins);
    for (int k = 0; k < 8; ++k, step = std::nextafter(step, 0.0f))
      if (std::floor(kTurn / step) > std::floor(last / step)) return step;
  }
  BP_CHECK(false, "no angle step near " << kWishedStep);
  return 0;
}

pcl::PointCloud<Point>::Ptr cloud_of(const PointCloud& cloud) {
  auto out = pcl::make_shared<pcl::PointCloud<Point>>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Point p;
    p.getVector3fMap() = cloud.points[i].cast<float>();
    p.getNormalVector3fMap() = cloud.normals[i].cast<float>();
    out->push_back(p);
  }
  return out;
}

PeerSettings pcl_defaults() {
  PeerSettings settings;
  settings.reference_step = 20;  // four times what OpenCV is given: a look takes half a minute as it is
  return settings;
}

class PclPeer : public Peer {
 public:
  PclPeer() : Peer(pcl_defaults()) { pcl::console::setVerbosityLevel(pcl::console::L_ERROR); }

 private:
  struct Model {
    pcl::PointCloud<Point>::Ptr cloud;
    pcl::PPFHashMapSearch::Ptr search;
    double diameter = 0;
  };

  void forget() override { models_.clear(); }
  void train(std::size_t, const PointCloud& model_P, double diameter) override {
    Model model;
    model.cloud = cloud_of(model_P);
    model.diameter = diameter;
    auto features = pcl::make_shared<pcl::PointCloud<pcl::PPFSignature>>();
    pcl::PPFEstimation<Point, Point, pcl::PPFSignature> estimation;
    estimation.setInputCloud(model.cloud);
    estimation.setInputNormals(model.cloud);
    estimation.compute(*features);
    model.search =
        pcl::make_shared<pcl::PPFHashMapSearch>(safe_angle_step(), static_cast<float>(settings().voxel * diameter));
    model.search->setInputFeatureCloud(features);
    models_.push_back(std::move(model));
  }
  std::vector<VotedPose> match(std::size_t part, const PointCloud& scene_C) const override {
    const Model& model = models_[part];
    Registration registration;
    registration.setSceneReferencePointSamplingRate(static_cast<unsigned int>(settings().reference_step));
    registration.setPositionClusteringThreshold(static_cast<float>(settings().cluster_distance * model.diameter));
    registration.setRotationClusteringThreshold(static_cast<float>(settings().cluster_angle));
    registration.setSearchMethod(model.search);
    registration.setInputSource(model.cloud);
    registration.setInputTarget(cloud_of(scene_C));
    pcl::PointCloud<Point> moved;
    registration.align(moved);
    std::vector<VotedPose> poses;
    for (const Cluster& c : kept_clusters) {
      const Eigen::Vector4d q = c.turn.cast<double>().normalized();
      const Eigen::Vector3d place = c.place.cast<double>() / c.poses;
      const Pose X_CP = pose_from(Eigen::Quaterniond(q).normalized().toRotationMatrix(), place);
      if (X_CP.matrix().allFinite()) poses.push_back({X_CP, static_cast<double>(c.votes)});
    }
    return poses;
  }

  std::vector<Model> models_;
};

}  // namespace

std::unique_ptr<PoseEstimator> make_pcl_peer() { return std::make_unique<PclPeer>(); }

}  // namespace binpick

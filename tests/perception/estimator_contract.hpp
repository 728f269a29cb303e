// What every pose estimator promises (docs: doors for newcomers): rigid poses, the same answer to the same input, poses
// that follow the camera, nothing in an empty frame. Whoever includes this says for which estimators.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/error.hpp"
#include "core/yaml.hpp"
#include "perception/pose_estimator.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {

using namespace testing_scene;

/// An estimator's name, and what its section of a scene says beside it.
struct ContractCase {
  std::string name, yaml;
};
inline void PrintTo(const ContractCase& c, std::ostream* stream) { *stream << c.name; }

inline std::unique_ptr<PoseEstimator> made(const ContractCase& c) {
  std::unique_ptr<PoseEstimator> estimator = make_estimator(c.name);
  if (!c.yaml.empty()) read_yaml_text(c.yaml, "contract", "/", [&](ConfigVisitor& v) { estimator->visit(v); });
  return estimator;
}

class EstimatorContract : public ::testing::TestWithParam<ContractCase> {
 protected:
  EstimatorContract() : part_(ring_part()), estimator_(made(GetParam())) {
    estimator_->validate();
    estimator_->prepare(std::span<const Part>(&part_, 1));
  }
  Part part_;
  std::unique_ptr<PoseEstimator> estimator_;
};

TEST_P(EstimatorContract, PosesAreRigidScoresOrderedAndAnswersRepeat) {
  const HeapScene scene = make_scene(part_, HeapOptions(), Seed{11}, camera_above(0.6));
  const EstimateResult first = estimator_->estimate(scene.view, Seed{1}),
                       again = estimator_->estimate(scene.view, Seed{1});
  ASSERT_EQ(first.status, EstimateStatus::kFound);
  ASSERT_EQ(first.estimates.size(), again.estimates.size());
  for (std::size_t i = 0; i < first.estimates.size(); ++i) {
    const PoseEstimate& e = first.estimates[i];
    EXPECT_TRUE(is_rigid(e.X_CP));
    EXPECT_EQ(e.part, 0u);
    EXPECT_TRUE(e.score >= 0 && e.score <= 1) << e.score;
    EXPECT_TRUE(e.inlier_fraction >= 0 && e.inlier_fraction <= 1) << e.inlier_fraction;
    EXPECT_GE(e.fit_rms, 0);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(e.covariance).eigenvalues().minCoeff(), 0);
    EXPECT_GT(std::sqrt(e.covariance(5, 5)), 1.0);  // nobody can know a ring's turn about its own axis
    if (i > 0) {
      EXPECT_LE(e.score, first.estimates[i - 1].score);
    }
    EXPECT_TRUE((e.X_CP.matrix().array() == again.estimates[i].X_CP.matrix().array()).all());
    EXPECT_EQ(e.score, again.estimates[i].score);
  }
}

TEST_P(EstimatorContract, FollowsTheCamera) {
  HeapOptions options;
  options.noise = false;
  options.count = 3;
  const Pose moved = camera_above(0.62) * pose_from_xyz_rpy({0.02, -0.01, 0}, {0.05, -0.04, 0.3});
  const HeapScene a = make_scene(part_, options, Seed{12}, camera_above(0.6));
  const HeapScene b = make_scene(part_, options, Seed{12}, moved);
  const auto from_a = estimator_->estimate(a.view, Seed{1}).estimates,
             from_b = estimator_->estimate(b.view, Seed{1}).estimates;
  ASSERT_FALSE(from_a.empty());
  for (const PoseEstimate& e : from_a) {
    double nearest = 1;
    for (const PoseEstimate& f : from_b)
      nearest = std::min(nearest, mssd(part_, a.X_WC * e.X_CP, b.X_WC * f.X_CP, hull_vertices(part_.mesh_P)));
    EXPECT_LT(nearest, 0.0025);
  }
}

TEST_P(EstimatorContract, FindsNothingInAnEmptyFrameAnEmptyBinOrAnEmptyCloud) {
  SceneView view;
  DepthFrame frame;
  frame.depth = Image<float>(frame.camera.width, frame.camera.height, std::numeric_limits<float>::quiet_NaN());
  view.seen = frame;
  view.bin = BinSpec();
  view.X_CB = camera_above(0.6).inverse();
  EXPECT_EQ(estimator_->estimate(view, Seed{1}).status, EstimateStatus::kNothingFound);
  view.seen = PointCloud();
  EXPECT_EQ(estimator_->estimate(view, Seed{1}).status, EstimateStatus::kNothingFound);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const HeapScene empty = photograph(part_, {}, HeapOptions(), Seed{seed}, camera_above(0.6));
    EXPECT_TRUE(estimator_->estimate(empty.view, Seed{1}).estimates.empty()) << "seed " << seed;
  }
}

TEST_P(EstimatorContract, ReadsBackItsOwnConfiguration) {
  const std::string yaml = write_yaml([&](ConfigVisitor& v) { estimator_->visit(v); });
  const auto other = make_estimator(GetParam().name);
  read_yaml_text(yaml, "written", "", [&](ConfigVisitor& v) { other->visit(v); });
  EXPECT_EQ(write_yaml([&](ConfigVisitor& v) { other->visit(v); }), yaml);
}

}  // namespace binpick

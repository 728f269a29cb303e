// What a pose shows in detail: blocks under a camera that looks straight down, exact depth.
#include "perception/pose_evidence.hpp"

#include <gtest/gtest.h>

#include "perception/pose_estimator.hpp"
#include "perception/preprocess.hpp"
#include "perception/view_check.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

/// Middle of the base at the origin.
Part block(const Eigen::Vector3d& size) {
  SymmetrySpec symmetry;
  symmetry.type = "dihedral";
  symmetry.axis = Eigen::Vector3d::UnitZ();
  symmetry.perpendicular = Eigen::Vector3d::UnitX();
  symmetry.point = Eigen::Vector3d::Zero();
  symmetry.order = 2;
  return part_from("block", mesh_of(Primitive::box(size)), symmetry);
}

struct Look {
  Scene scene;
  Pose X_CW;
};

/// A block of the size whose top lies 40 mm above the floor, under the middle of the camera.
Look look_at_block(const Eigen::Vector3d& size) {
  HeapOptions options;
  options.noise = false;
  const HeapScene made = photograph(block(size), {{0, pose_from_xyz_rpy({0, 0, 0.04 - size.z() / 2}, {0, 0, 0}), 0, 0}},
                                    options, Seed{1}, camera_above(0.6));
  return {binpick::make_scene(made.view, PreprocessConfig(), NormalsConfig(), size.z()), made.X_WC.inverse()};
}

/// A block of 60 x 40 x 20 mm is believed where its top lies so high.
PoseEvidence believed(const Look& look, double top, std::uint8_t taken = 0) {
  const Part part = block({0.06, 0.04, 0.02});
  const SurfaceModel model(part.mesh_P, 0.02 * part.diameter, 0.1 * part.diameter);
  const std::vector<std::uint8_t> others(look.scene.depth.size(), taken);
  const Pose X_CP = look.X_CW * pose_from_xyz_rpy({0, 0, top - 0.01}, {0, 0, 0});
  return gather_evidence(look.scene, model, X_CP, others, CheckConfig());
}

TEST(PoseEvidence, NothingSpeaksAgainstABlockInItsPlace) {
  const PoseEvidence e = believed(look_at_block({0.06, 0.04, 0.02}), 0.04);
  EXPECT_EQ(e.rims.leak_side, 0);
  EXPECT_EQ(e.rims.attached, 0);
  EXPECT_GT(e.rims.judged, 0.9);
  EXPECT_EQ(e.parallel, 0);
  EXPECT_EQ(e.foreign, 0);
  EXPECT_EQ(e.hollow, 0);
  EXPECT_EQ(e.smooth_cover, 0);
  EXPECT_LT(e.residual, 0.5);
  EXPECT_LT(e.turned, 0.02);
}

TEST(PoseEvidence, ABlockOnALongerOneLeaksAtItsEndsUnlessAnotherPoseExplainsWhatFollows) {
  const Look look = look_at_block({0.16, 0.04, 0.02});
  EXPECT_GT(believed(look, 0.04).rims.leak_side,
            0.7);  // 30 px at an end, of which those next to the corners look sideways
  EXPECT_EQ(believed(look, 0.04, 1).rims.leak_side, 0);
}

TEST(PoseEvidence, WhatCoversAPoseFromJustAboveIsNoOccluderUnlessAnotherPoseExplainsIt) {
  const Look look = look_at_block({0.16, 0.12, 0.02});
  EXPECT_GT(believed(look, 0.034).parallel, 0.9);  // 6 mm under the top
  EXPECT_EQ(believed(look, 0.034, 1).parallel, 0);
  EXPECT_EQ(believed(look, 0.020).parallel, 0);  // 20 mm under it
  EXPECT_GT(believed(look, 0.020).foreign, 0.9);
  EXPECT_EQ(believed(look, 0.020, 1).foreign, 0);
}

TEST(PoseEvidence, HalfABlockIsSeenThrough) {
  // Each half has some 25 x 35 pixels; of those seen through, a rim of one does not count, at the middle another of
  // two.
  const PoseEvidence e = believed(look_at_block({0.03, 0.04, 0.02}), 0.04);
  EXPECT_GT(e.hollow, 0.5);
  EXPECT_LT(e.hollow, 1);
}

TEST(PoseEvidence, ASurfaceThatBendsAtTheOutlineHangsTogether) {
  // A beam of 60 x 40 x 40 mm on edge: the block's top is one of its two upper faces, and at the ridge the other
  // begins.
  HeapOptions options;
  options.noise = false;
  const Pose X_WO = pose_from_xyz_rpy({0, 0, 0.06}, {std::numbers::pi / 4, 0, 0});
  const HeapScene made = photograph(block({0.06, 0.04, 0.04}), {{0, X_WO, 0, 0}}, options, Seed{1}, camera_above(0.6));
  const Part part = block({0.06, 0.04, 0.002});
  const SurfaceModel model(part.mesh_P, 0.02 * part.diameter, 0.1 * part.diameter);
  const Scene scene = binpick::make_scene(made.view, PreprocessConfig(), NormalsConfig(), 0.002);
  const std::vector<std::uint8_t> nobody(scene.depth.size(), 0), others(scene.depth.size(), 1);
  const Pose X_CP = made.X_WC.inverse() * X_WO * pose_from_xyz_rpy({0, 0, 0.019}, {0, 0, 0});
  const RimEvidence rims = gather_evidence(scene, model, X_CP, nobody, CheckConfig()).rims;
  EXPECT_GT(rims.attached, 0.6);
  EXPECT_LT(rims.leak_side, 0.2);  // nowhere straight on
  EXPECT_EQ(gather_evidence(scene, model, X_CP, others, CheckConfig()).rims.attached, 0);
}

TEST(PoseEvidence, ResidualsAreMeasuredInWhatTheStatedNoiseLeavesOfAPatch) {
  // 2 mm off where at least 0.5 mm are granted: 36 pixels of independent noise leave a sixth, and a tenth stays anyhow.
  const double expected = 0.002 / (0.0005 * std::sqrt(1.0 / 36 + 0.01));
  EXPECT_NEAR(believed(look_at_block({0.06, 0.04, 0.02}), 0.042).residual, expected, 0.2 * expected);
}

TEST(PoseEvidence, APartIsNotFoundOnALargerFaceOfAnother) {
  const Part part = block({0.06, 0.04, 0.02});
  const auto estimator = make_estimator("ppf");
  estimator->prepare(std::span<const Part>(&part, 1));
  const Part larger = block({0.16, 0.12, 0.02});
  const std::vector<Instance> lying = {{0, pose_from_xyz_rpy({0.09, 0.02, 0.01}, {0, 0, 0.3}), 0, 0},
                                       {0, pose_from_xyz_rpy({-0.1, 0, 0.01}, {0, 0, 1.4}), 0, 0}};
  for (const bool noise : {false, true}) {
    HeapOptions options;
    options.noise = noise;
    const HeapScene made = photograph(larger, lying, options, Seed{2}, camera_above(0.6));
    EXPECT_TRUE(estimator->estimate(made.view, Seed{1}).estimates.empty()) << noise;
  }
}

}  // namespace
}  // namespace binpick

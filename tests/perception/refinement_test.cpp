// Verification and ICP on scenes of one part whose pose is known.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "perception/preprocess.hpp"
#include "perception/view_check.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

struct OnePart {
  Part part;
  SurfaceModel surface;
  Scene scene;
  Pose X_CP;

  OnePart(Part p, const Pose& X_WP)
      : part(std::move(p)), surface(part.mesh_P, 0.02 * part.diameter, 0.1 * part.diameter) {
    HeapOptions options;
    options.noise = false;
    const HeapScene photo = photograph(part, {{0, X_WP, 0, 0}}, options, Seed{1}, camera_above(0.6));
    scene = make_scene(photo.view, PreprocessConfig(), NormalsConfig(), 0.006);
    X_CP = photo.X_WC.inverse() * X_WP;
  }
};

Pose leaning() { return pose_from_xyz_rpy({0.02, -0.03, 0.05}, {0.5, 0.3, 0.7}); }

TEST(Icp, ComesBackFromAKnownOffset) {
  const OnePart one(bracket_part(), leaning());
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    Vector6d twist;
    twist << 0.003 * rng.unit_vector(), 0.06 * rng.unit_vector();
    const Pose start = one.X_CP * exp_se3(twist);
    const IcpResult coarse = refine_pose(one.scene, one.surface, start, IcpConfig(), IcpStage::kCoarse);
    const IcpResult fine = refine_pose(one.scene, one.surface, coarse.X_CP, IcpConfig(), IcpStage::kFine);
    EXPECT_LT(distance_between(fine.X_CP, one.X_CP), 0.0006) << "seed " << seed;
    EXPECT_LT(angle_between(fine.X_CP.linear(), one.X_CP.linear()), 0.012) << "seed " << seed;
    EXPECT_LT(fine.mean_deviation, 0.001) << "seed " << seed;  // the paper's threshold
  }
}

TEST(Icp, StaysAtTheTruthAndStatesHowWellItKnowsIt) {
  const OnePart one(ring_part(), pose_from_xyz_rpy({0, 0, 0.008}, {0, 0, 0}));
  const IcpResult fine = refine_pose(one.scene, one.surface, one.X_CP, IcpConfig(), IcpStage::kFine);
  EXPECT_LT(distance_between(fine.X_CP, one.X_CP), 0.0005);
  const Vector6d sigma = fine.covariance.diagonal().cwiseSqrt();
  EXPECT_LT(sigma[2], 0.001);  // height and tilt of a flat ring are well seen
  EXPECT_LT(sigma[3], 0.05);
  EXPECT_GT(sigma[0], sigma[2]);  // its place sideways hangs on the outline alone
  EXPECT_GT(sigma[5], sigma[3]);  // the turn about its axis on nothing but the facets
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(fine.covariance).eigenvalues().minCoeff(), 0);
}

TEST(Icp, AcceptedDeviationIsThePapersPlusTheSensors) {
  Scene scene;
  IcpConfig config;
  EXPECT_DOUBLE_EQ(accepted_deviation(scene, 0.6, config), 0.001);
  scene.noise.quadratic = 0.00372;
  EXPECT_NEAR(accepted_deviation(scene, 0.6, config), 0.001 + 0.00134, 1e-5);
  config.accept_sigmas = 0;
  EXPECT_DOUBLE_EQ(accepted_deviation(scene, 0.6, config), 0.001);
}

TEST(HypothesisCheck, TruthIsAllInliersAndFreeSpaceRefutes) {
  const OnePart one(bracket_part(), leaning());
  const CheckConfig config;
  const CheckCounts truth = check_rays(one.scene, one.surface, one.X_CP, config);
  // Which points are visible is known for 64 directions only, so a few near the part's own edges are not.
  EXPECT_GT(truth.inliers / truth.tried, 0.8f);
  EXPECT_LT(truth.through / truth.tried, 0.05f);
  Pose raised = one.X_CP;
  raised.translation().z() -= 0.02;  // towards the camera: everything behind it is seen through it
  const CheckCounts above = check_rays(one.scene, one.surface, raised, config);
  EXPECT_GT(above.through / above.tried, 0.8f);
  EXPECT_LT(above.score(), 0.0);
  Pose sunk = one.X_CP;
  sunk.translation().z() += 0.02;
  const CheckCounts below = check_rays(one.scene, one.surface, sunk, config);
  EXPECT_GT(below.occluded / below.tried, 0.7f);
  EXPECT_LT(below.through / below.tried, 0.2f);
}

TEST(HypothesisCheck, VoxelShareFallsWithTheOffset) {
  const OnePart one(bracket_part(), leaning());
  const VoxelSet voxels(one.scene, 0.005);
  EXPECT_GT(voxel_share(voxels, one.surface, one.X_CP, 250), 0.9);
  Pose off = one.X_CP;
  off.translation().z() -= 0.04;
  EXPECT_LT(voxel_share(voxels, one.surface, off, 250), 0.3);
}

TEST(HypothesisCheck, NothingLiesBelowTheFloorOrBehindAWall) {
  const OnePart one(ring_part(), pose_from_xyz_rpy({0, 0, 0.008}, {0, 0, 0}));
  const CheckConfig config;
  EXPECT_TRUE(fits_bin(one.scene, one.surface, one.X_CP, config));
  const auto moved = [&](double x, double z) { return pose_from_xyz_rpy({x, 0, -z}, {0, 0, 0}) * one.X_CP; };
  EXPECT_FALSE(fits_bin(one.scene, one.surface, moved(0, -0.008), config));  // 8 mm into the floor
  EXPECT_TRUE(fits_bin(one.scene, one.surface, moved(0.148, 0), config));    // 50 + 148 < 200 mm
  EXPECT_FALSE(fits_bin(one.scene, one.surface, moved(0.160, 0), config));   // 10 mm into the wall
}

TEST(ViewCheck, TruthIsAcceptedAndAPoseOnALargerFaceLeaks) {
  const OnePart one(bracket_part(), leaning());
  const ViewCheck truth = check_view(one.scene, one.surface, one.X_CP, CheckConfig());
  EXPECT_TRUE(accepted(truth, AcceptConfig()));
  EXPECT_LT(truth.leak, 0.1);
  EXPECT_GT(truth.score(), 0.8);
  // A small plate laid onto the middle of a large slab agrees in depth everywhere; only its outline shows the error.
  const OnePart slab(part_from("slab", mesh_of(Primitive::box({0.2, 0.2, 0.03})), {}),
                     pose_from_xyz_rpy({0, 0, 0.015}, {0, 0, 0}));
  const SurfaceModel plate(mesh_of(Primitive::box({0.06, 0.06, 0.01})), 0.002, 0.008);
  const Pose X_CP = camera_above(0.6).inverse() * pose_from_xyz_rpy({0, 0, 0.025}, {0, 0, 0});
  const ViewCheck leaning_on = check_view(slab.scene, plate, X_CP, CheckConfig());
  EXPECT_GT(leaning_on.quality(), 0.95);
  EXPECT_GT(leaning_on.leak, 0.9);
  EXPECT_FALSE(accepted(leaning_on, AcceptConfig()));
}

TEST(ViewCheck, OfTwoPosesInOnePlaceTheBetterStays) {
  const OnePart one(bracket_part(), leaning());
  const auto candidate = [&](const Pose& X) {
    Candidate c;
    c.fit.X_CP = X;
    c.check = check_view(one.scene, one.surface, X, CheckConfig());
    return c;
  };
  Pose near = one.X_CP;
  near.translation().x() += 0.002;
  const auto standing = resolve_conflicts({candidate(near), candidate(one.X_CP), candidate(near)}, {&one.surface},
                                          one.scene, AcceptConfig());
  ASSERT_EQ(standing.size(), 1u);
  EXPECT_TRUE(standing[0].fit.X_CP.isApprox(one.X_CP));
}

}  // namespace
}  // namespace binpick

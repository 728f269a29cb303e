// What the estimator says of views that do not hold the answer.
#include "perception/rival_poses.hpp"

#include <gtest/gtest.h>

#include "perception/pose_estimator.hpp"
#include "perception/preprocess.hpp"
#include "perception/view_ambiguity.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

/// Base up, upright hidden below, the middle of the base at a place of the bin.
Pose base_up(double x, double y, double turn) {
  const Eigen::Matrix3d R = exp_so3({0, 0, turn}) * exp_so3({std::numbers::pi, 0, 0});
  return pose_from(R, Eigen::Vector3d(x, y, 0.06) - R * Eigen::Vector3d(0.045, 0, 0));
}

EstimateResult estimate(const Part& part, const SceneView& view) {
  const auto estimator = make_estimator("ppf");
  estimator->prepare(std::span<const Part>(&part, 1));
  return estimator->estimate(view, Seed{1});
}

TEST(RivalPoses, ABracketFromBehindIsFlaggedAndComesAfterOneThatShowsItself) {
  const Part bracket = bracket_part();
  const Pose plain = pose_from_xyz_rpy({-0.12, 0.05, 0}, {0, 0, 0.4});
  for (const bool noise : {false, true}) {
    HeapOptions options;
    options.noise = noise;
    const HeapScene scene =
        photograph(bracket, {{0, base_up(0, 0, 0.3), 0, 0}, {0, plain, 0, 0}}, options, Seed{3}, camera_above(0.6));
    const auto found = estimate(bracket, scene.view).estimates;
    ASSERT_EQ(found.size(), 2u) << noise;
    EXPECT_FALSE(found[0].ambiguous) << noise;
    EXPECT_TRUE(found[1].ambiguous) << noise;
    const auto vertices = hull_vertices(bracket.mesh_P);
    EXPECT_LT(mssd(bracket, found[0].X_CP, scene.X_WC.inverse() * plain, vertices), 0.1 * bracket.diameter) << noise;
    // One of the two twins: the base lies where it lies.
    const Eigen::Vector3d middle = scene.X_WC.inverse() * Eigen::Vector3d(0, 0, 0.06);
    EXPECT_LT((found[1].X_CP * Eigen::Vector3d(0.045, 0, 0) - middle).norm(), 0.003) << noise;
  }
}

TEST(RivalPoses, WhereTheUprightCanBeSeenTheRightTwinIsKeptAndTheWrongOneReplaced) {
  const Part bracket = bracket_part();
  HeapOptions options;
  options.noise = false;
  const SurfaceModel model(bracket.mesh_P, 0.02 * bracket.diameter, 0.1 * bracket.diameter);
  const auto overlaps = self_overlaps(bracket.mesh_P, bracket.symmetry, bracket.diameter);
  const AmbiguousViews views(bracket);
  const Pose half_turn = pose_from(exp_so3({0, 0, std::numbers::pi}), {0.09, 0, 0});
  const RivalConfig rivals;
  const IcpConfig icp;
  const CheckConfig check;
  for (const double turn : {0.0, std::numbers::pi}) {  // to the right of the camera: one turn shows the outer face
    const Pose X_WP = base_up(0.13, 0, turn);
    const HeapScene made = photograph(bracket, {{0, X_WP, 0, 0}}, options, Seed{5}, camera_above(0.6));
    const Scene scene = binpick::make_scene(made.view, PreprocessConfig(), NormalsConfig(), 0.006);
    const Pose X_CP = made.X_WC.inverse() * X_WP;
    ASSERT_FALSE(views.ambiguous(X_CP, made.frame.camera, made.frame.noise, &made.frame.depth)) << turn;
    for (const bool wrong : {false, true}) {
      Candidate c;
      c.fit.X_CP = wrong ? X_CP * half_turn : X_CP;
      c.check = check_view(scene, model, c.fit.X_CP, check);
      const std::vector<std::uint8_t> nobody(scene.depth.size(), 0);
      EXPECT_EQ(settle_rivals(scene, model, overlaps, {rivals, icp, check}, nobody, c), wrong) << turn;
      EXPECT_FALSE(c.ambiguous) << turn << " " << wrong;
      EXPECT_LT(mssd(bracket, c.fit.X_CP, X_CP, hull_vertices(bracket.mesh_P)), 0.002) << turn << " " << wrong;
    }
  }
}

/// A block of 60 x 40 mm, 25 mm high at one end and 15 at the other. Base down or top down, it looks much the same.
Part wedge_part() {
  TriangleMesh mesh;
  for (const double y : {-0.02, 0.02})
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(-0.03, 0), {0.03, 0}, {0.03, 0.015}, {-0.03, 0.025}})
      mesh.vertices.emplace_back(p.x(), y, p.y());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};  // the sides
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t n = (k + 1) % 4;
    mesh.triangles.push_back({k, k + 4, n + 4});
    mesh.triangles.push_back({k, n + 4, n});
  }
  return part_from("wedge", mesh, {});
}

TEST(RivalPoses, ASharpOutlineTellsTwinsOfABlockApartAndABlurredOneDoesNot) {
  const Part wedge = wedge_part();
  ASSERT_GT(wedge.mass.volume, 0);  // closed and outward
  HeapOptions options;
  options.noise = false;
  const SurfaceModel model(wedge.mesh_P, 0.02 * wedge.diameter, 0.1 * wedge.diameter);
  const auto overlaps = self_overlaps(wedge.mesh_P, wedge.symmetry, wedge.diameter);
  ASSERT_FALSE(overlaps.empty());
  const IcpConfig icp;
  const CheckConfig check;
  const Pose X_WP = pose_from_xyz_rpy({-0.12, -0.03, 0}, {0, 0, 0.4});  // shows an end
  const HeapScene made = photograph(wedge, {{0, X_WP, 0, 0}}, options, Seed{6}, camera_above(0.6));
  const Scene scene = binpick::make_scene(made.view, PreprocessConfig(), NormalsConfig(), 0.015);
  const std::vector<std::uint8_t> nobody(scene.depth.size(), 0);
  const Pose X_CP = made.X_WC.inverse() * X_WP;
  const auto settled = [&](const Pose& begin, double least_difference) {
    Candidate c;
    c.fit = refine_pose(scene, model, begin, icp, IcpStage::kFine);
    c.check = check_view(scene, model, c.fit.X_CP, check);
    RivalConfig rivals;
    rivals.least_difference = least_difference;
    settle_rivals(scene, model, overlaps, {rivals, icp, check}, nobody, c);
    return c;
  };
  const auto vertices = hull_vertices(wedge.mesh_P);
  int twins = 0;
  for (const SelfOverlap& overlap : overlaps) {
    const Pose twin = X_CP * overlap.T;
    if (!settled(twin, 3 * RivalConfig().least_difference).ambiguous) continue;  // as if outlines were blurred
    ++twins;
    const Candidate c = settled(twin, RivalConfig().least_difference);
    EXPECT_FALSE(c.ambiguous);
    EXPECT_LT(mssd(wedge, c.fit.X_CP, X_CP, vertices), 0.1 * wedge.diameter);
  }
  EXPECT_GT(twins, 0);
  EXPECT_FALSE(settled(X_CP, RivalConfig().least_difference).ambiguous);
}

}  // namespace
}  // namespace binpick

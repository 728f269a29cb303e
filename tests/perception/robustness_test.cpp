// What must not disturb the estimator, and what it says when it finds nothing.
#include <gtest/gtest.h>

#include "core/yaml.hpp"
#include "perception/pose_estimator.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

std::unique_ptr<PoseEstimator> prepared(const Part& part) {
  auto estimator = make_estimator("ppf");
  estimator->prepare(std::span<const Part>(&part, 1));
  return estimator;
}

bool is_right(const Part& part, const PoseEstimate& e, const HeapScene& scene) {
  const auto vertices = hull_vertices(part.mesh_P);
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& i) {
    return mssd(part, e.X_CP, scene.X_WC.inverse() * i.X_WP, vertices) < 0.1 * part.diameter;
  });
}

void expect_same_bits(const EstimateResult& a, const EstimateResult& b, const std::string& what) {
  ASSERT_EQ(a.estimates.size(), b.estimates.size()) << what;
  for (std::size_t i = 0; i < a.estimates.size(); ++i) {
    EXPECT_TRUE((a.estimates[i].X_CP.matrix().array() == b.estimates[i].X_CP.matrix().array()).all()) << what;
    EXPECT_EQ(a.estimates[i].score, b.estimates[i].score) << what;
    EXPECT_EQ(a.estimates[i].ambiguous, b.estimates[i].ambiguous) << what;
    EXPECT_TRUE((a.estimates[i].covariance.array() == b.estimates[i].covariance.array()).all()) << what;
  }
}

TEST(Robustness, FloorAndWallsLeftInTheCloudCostNoPrecision) {
  const Part ring = ring_part();
  const auto estimator = prepared(ring);
  std::size_t right = 0, all = 0, found_with_bin = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    HeapScene scene = make_scene(ring, HeapOptions(), Seed{seed}, camera_above(0.6));
    found_with_bin += estimator->estimate(scene.view, Seed{1}).estimates.size();
    scene.view.bin.reset();
    for (const PoseEstimate& e : estimator->estimate(scene.view, Seed{1}).estimates)
      ++all, right += is_right(ring, e, scene);
  }
  EXPECT_EQ(right, all);
  EXPECT_GT(3 * all, found_with_bin);  // what lies on a floor that nobody knows of is hard to tell from it
}

TEST(Robustness, AnotherPartIsNotFound) {
  const Part ring = ring_part(), bracket = bracket_part();
  const HeapScene rings = make_scene(ring, HeapOptions(), Seed{3}, camera_above(0.6));
  const HeapScene brackets = make_scene(bracket, HeapOptions(), Seed{3}, camera_above(0.6));
  const EstimateResult none = prepared(bracket)->estimate(rings.view, Seed{1});
  EXPECT_EQ(none.status, EstimateStatus::kNothingFound);
  EXPECT_EQ(none.message, "no pose of a wanted part is borne out by the view");
  EXPECT_TRUE(prepared(ring)->estimate(brackets.view, Seed{1}).estimates.empty());
}

TEST(Robustness, ClutterBehindAndBesideTheBinChangesNothing) {
  const Part ring = ring_part();
  const auto estimator = prepared(ring);
  HeapScene scene = make_scene(ring, HeapOptions(), Seed{4}, camera_above(0.6));
  const EstimateResult before = estimator->estimate(scene.view, Seed{1});
  DepthFrame frame = scene.frame;
  Rng rng = Seed{4}.child("clutter").rng();
  for (int v = 0; v < frame.depth.height(); ++v)  // outside the rim of 400 x 300 mm at 0.4 m
    for (int u = 0; u < frame.depth.width(); ++u)
      if (std::abs(u - frame.camera.cx) > 245 || std::abs(v - frame.camera.cy) > 190)
        frame.depth(u, v) = static_cast<float>(rng.uniform(0.5, 2.5));
  scene.view.seen = frame;
  expect_same_bits(before, estimator->estimate(scene.view, Seed{1}), "clutter");
}

TEST(Robustness, NeitherThreadsNorSeedNorTheWorldChangeABit) {
  const Part bracket = bracket_part();
  const auto estimator = prepared(bracket);
  HeapScene scene = make_scene(bracket, HeapOptions(), Seed{5}, camera_above(0.6));
  const EstimateResult one = estimator->estimate(scene.view, Seed{1});
  ASSERT_FALSE(one.estimates.empty());
  for (const int threads : {2, 3}) {
    scene.view.threads = threads;
    expect_same_bits(one, estimator->estimate(scene.view, Seed{7}), std::to_string(threads) + " threads");
  }
  DepthFrame frame = scene.frame;  // cell, bin and camera carried elsewhere together: C sees the same
  frame.X_WC = pose_from_xyz_rpy({3, -2, 1}, {0.4, 0.1, -2}) * frame.X_WC;
  scene.view.seen = frame;
  expect_same_bits(one, estimator->estimate(scene.view, Seed{1}), "moved");
}

TEST(Robustness, ATurnAboutTheLineOfSightTurnsThePoses) {
  const Part ring = ring_part();
  const auto estimator = prepared(ring);
  HeapScene scene = make_scene(ring, HeapOptions(), Seed{6}, camera_above(0.6));
  const auto before = estimator->estimate(scene.view, Seed{1}).estimates;
  DepthFrame turned = scene.frame;  // by half a turn: u and v count from the other end
  for (int v = 0; v < turned.depth.height(); ++v)
    for (int u = 0; u < turned.depth.width(); ++u)
      turned.depth(u, v) = scene.frame.depth(turned.depth.width() - 1 - u, turned.depth.height() - 1 - v);
  const Pose half = pose_from(exp_so3({0, 0, std::numbers::pi}), Eigen::Vector3d::Zero());
  scene.view.seen = turned;
  scene.view.X_CB = half * scene.view.X_CB;
  const auto after = estimator->estimate(scene.view, Seed{1}).estimates;
  ASSERT_FALSE(before.empty());
  std::size_t again = 0;
  for (const PoseEstimate& e : before)
    again += std::any_of(after.begin(), after.end(), [&](const PoseEstimate& f) {
      return mssd(ring, half * e.X_CP, f.X_CP, hull_vertices(ring.mesh_P)) < 0.002;
    });
  EXPECT_GE(again + 1, before.size());
}

TEST(Robustness, SaysWhyItFoundNothing) {
  const Part ring = ring_part();
  const auto estimator = prepared(ring);
  SceneView view;
  view.seen = PointCloud{{Eigen::Vector3d::Constant(std::nan("")), Eigen::Vector3d(0, 0, std::nan(""))}, {}};
  EXPECT_EQ(estimator->estimate(view, Seed{1}).message, "no depth in view");
  view.seen = PointCloud{{{0, 0, 0.5}, {0.01, 0, 0.5}, {0, 0.01, 0.5}}, {}};
  const EstimateResult three = estimator->estimate(view, Seed{1});
  EXPECT_EQ(three.status, EstimateStatus::kNothingFound);
  EXPECT_NE(three.message.find("points to look at"), std::string::npos) << three.message;
  const HeapScene empty = photograph(ring, {}, HeapOptions(), Seed{1}, camera_above(0.6));
  EXPECT_FALSE(estimator->estimate(empty.view, Seed{1}).message.empty());
}

TEST(Robustness, APartLargerThanTheBinIsSaidToBeSo) {
  const Part beam = part_from("beam", mesh_of(Primitive::box({0.9, 0.05, 0.05})), {});
  const HeapScene scene = make_scene(ring_part(), HeapOptions(), Seed{8}, camera_above(0.6));
  const EstimateResult none = prepared(beam)->estimate(scene.view, Seed{1});
  EXPECT_TRUE(none.estimates.empty());
  EXPECT_EQ(none.message, "the part is larger than the bin");
}

TEST(Robustness, AnOpenMeshGivesRigidPosesOrNone) {
  TriangleMesh mesh = bracket_part().mesh_P;
  mesh.triangles.resize(mesh.triangles.size() - 6);  // the boss loses a piece
  const Part open = part_from("open", mesh, {});
  const HeapScene scene = make_scene(bracket_part(), HeapOptions(), Seed{9}, camera_above(0.6));
  const EstimateResult result = prepared(open)->estimate(scene.view, Seed{1});
  for (const PoseEstimate& e : result.estimates) EXPECT_TRUE(is_rigid(e.X_CP));
  EXPECT_EQ(result.estimates.empty(), !result.message.empty());
}

}  // namespace
}  // namespace binpick

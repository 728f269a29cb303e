// The paper's pipeline on whole scenes.
#include <gtest/gtest.h>

#include "core/yaml.hpp"
#include "perception/pose_estimator.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

struct Tally {
  int visible = 0, found = 0, returned = 0, right = 0, first_right = 0;
};

/// Right: every vertex within a tenth of the diameter, one to one; recall over parts at least half visible.
void count(const Part& part, const HeapScene& scene, const EstimateResult& result, Tally& tally) {
  std::vector<char> taken(scene.instances.size(), 0);
  const auto vertices = hull_vertices(part.mesh_P);
  for (std::size_t e = 0; e < result.estimates.size(); ++e) {
    bool right = false;
    for (std::size_t i = 0; i < scene.instances.size() && !right; ++i) {
      if (taken[i]) continue;
      const Pose X_CP = scene.X_WC.inverse() * scene.instances[i].X_WP;
      right = mssd(part, result.estimates[e].X_CP, X_CP, vertices) < 0.1 * part.diameter;
      if (right) taken[i] = 1;
    }
    ++tally.returned;
    tally.right += right;
    if (e == 0) tally.first_right += right;
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    if (scene.instances[i].visible_fraction >= 0.5) {
      ++tally.visible;
      tally.found += taken[i];
    }
}

std::unique_ptr<PoseEstimator> prepared(const Part& part, const std::string& yaml = "") {
  auto estimator = make_estimator("paper_ppf");
  if (!yaml.empty()) read_yaml_text(yaml, "test", "", [&](ConfigVisitor& v) { estimator->visit(v); });
  estimator->validate();
  estimator->prepare(std::span<const Part>(&part, 1));
  return estimator;
}

TEST(PaperPpf, OnePartLyingFlatIsFoundToHalfAMillimetre) {
  HeapOptions options;
  options.noise = false;
  for (const Part& part : {ring_part(), bracket_part()}) {
    const double half_height = part.name == "ring" ? 0.008 : 0;
    const Pose X_WP = pose_from_xyz_rpy({0.05, -0.04, half_height}, {0, 0, 0.6});
    const HeapScene scene = photograph(part, {{0, X_WP, 0, 0}}, options, Seed{1}, camera_above(0.6));
    const EstimateResult result = prepared(part)->estimate(scene.view, Seed{1});
    ASSERT_EQ(result.estimates.size(), 1u) << part.name;
    const Pose X_CP_true = scene.X_WC.inverse() * X_WP;
    const Pose X_CP = nearest_equivalent(result.estimates[0].X_CP, X_CP_true, part.symmetry);
    EXPECT_LT((X_CP * part.box_center_P - X_CP_true * part.box_center_P).norm(), 0.0005) << part.name;
    EXPECT_LT(angle_between(X_CP.linear(), X_CP_true.linear()), 0.5 * std::numbers::pi / 180) << part.name;
    EXPECT_GT(result.estimates[0].score, 0.8) << part.name;
    EXPECT_GT(result.wall.total, 0);
  }
}

TEST(PaperPpf, TenRingsUnderStereoNoise) {
  const Part ring = ring_part();
  const auto estimator = prepared(ring);
  Tally tally;
  for (std::uint64_t seed = 21; seed <= 24; ++seed)
    count(ring, make_scene(ring, HeapOptions(), Seed{seed}, camera_above(0.6)),
          estimator->estimate(make_scene(ring, HeapOptions(), Seed{seed}, camera_above(0.6)).view, Seed{1}), tally);
  EXPECT_GE(tally.visible, 30);
  EXPECT_GE(tally.found, 0.95 * tally.visible) << tally.found << " of " << tally.visible;
  EXPECT_GE(tally.right, 0.97 * tally.returned) << tally.right << " of " << tally.returned;
  EXPECT_EQ(tally.first_right, 4);
}

TEST(PaperPpf, AnOutOfBoxBiasIsTakenOffByTheFloor) {
  const Part ring = ring_part();
  const auto estimator = prepared(ring);
  HeapOptions options;
  options.bias_px = 0.3;  // 5 mm at the floor
  Tally tally;
  for (std::uint64_t seed = 31; seed <= 32; ++seed) {
    const HeapScene scene = make_scene(ring, options, Seed{seed}, camera_above(0.6));
    count(ring, scene, estimator->estimate(scene.view, Seed{1}), tally);
  }
  EXPECT_GE(tally.found, 0.9 * tally.visible) << tally.found << " of " << tally.visible;
  EXPECT_GE(tally.right, 0.95 * tally.returned) << tally.right << " of " << tally.returned;
}

TEST(PaperPpf, ASecondSearchLosesNothingOfTheFirst) {
  const Part bracket = bracket_part();
  const auto once = prepared(bracket, "search: {rounds: 1}"), twice = prepared(bracket);
  for (std::uint64_t seed = 61; seed <= 63; ++seed) {
    const HeapScene scene = make_scene(bracket, HeapOptions(), Seed{seed}, camera_above(0.6));
    Tally first, both;
    // Of twins that the view cannot tell apart either one may be given, in either search: those are flagged.
    const auto unflagged = [&](const PoseEstimator& estimator) {
      EstimateResult result = estimator.estimate(scene.view, Seed{1});
      std::erase_if(result.estimates, [](const PoseEstimate& e) { return e.ambiguous; });
      return result;
    };
    count(bracket, scene, unflagged(*once), first);
    count(bracket, scene, unflagged(*twice), both);
    EXPECT_GT(first.right, 0) << "seed " << seed;
    EXPECT_GE(both.right, first.right) << "seed " << seed;
    EXPECT_GE(both.found, first.found) << "seed " << seed;
  }
}

TEST(PaperPpf, ACloudWithoutOrderWillDo) {
  const Part ring = ring_part();
  HeapScene scene = make_scene(ring, HeapOptions(), Seed{41}, camera_above(0.6));
  PointCloud cloud = unproject(scene.frame);
  std::reverse(cloud.points.begin(), cloud.points.end());
  scene.view.seen = cloud;
  Tally tally;
  count(ring, scene, prepared(ring)->estimate(scene.view, Seed{1}), tally);
  EXPECT_GE(tally.found, 0.8 * tally.visible) << tally.found << " of " << tally.visible;
  EXPECT_GE(tally.right, 0.8 * tally.returned) << tally.right << " of " << tally.returned;
}

TEST(PaperPpf, ThePapersOwnStepsWork) {
  const Part ring = ring_part();
  const auto estimator = prepared(ring, "voting: {distance_step: 5 mm, angle_step: 12 deg}\nsearch: {edges: false}");
  Tally tally;
  const HeapScene scene = make_scene(ring, HeapOptions(), Seed{42}, camera_above(0.6));
  count(ring, scene, estimator->estimate(scene.view, Seed{1}), tally);
  EXPECT_GE(tally.found, 0.8 * tally.visible) << tally.found << " of " << tally.visible;
}

TEST(PaperPpf, TwoKindsOfPartsAreToldApart) {
  const std::vector<Part> parts = {ring_part(), bracket_part()};
  const auto estimator = make_estimator("paper_ppf");
  estimator->prepare(parts);
  HeapOptions options;
  options.noise = false;
  options.count = 1;
  for (std::size_t k = 0; k < 2; ++k) {
    const HeapScene scene = make_scene(parts[k], options, Seed{50}, camera_above(0.6));
    const auto found = estimator->estimate(scene.view, Seed{1}).estimates;
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].part, k);
  }
}

}  // namespace
}  // namespace binpick

// What `type: ppf` promises beyond the stages it shares with the paper's pipeline.
#include <gtest/gtest.h>

#include "core/yaml.hpp"
#include "perception/pose_estimator.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

std::unique_ptr<PoseEstimator> prepared(const Part& part, const std::string& yaml = "") {
  auto estimator = make_estimator("ppf");
  if (!yaml.empty()) read_yaml_text(yaml, "test", "", [&](ConfigVisitor& v) { estimator->visit(v); });
  estimator->validate();
  estimator->prepare(std::span<const Part>(&part, 1));
  return estimator;
}

bool right_for_one(const Part& part, const HeapScene& scene, const Pose& X_CP) {
  const auto vertices = hull_vertices(part.mesh_P);
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const auto& instance) {
    return mssd(part, X_CP, scene.X_WC.inverse() * instance.X_WP, vertices) < 0.1 * part.diameter;
  });
}

TEST(Ppf, OnePoseIsEnoughWhenOneIsAskedFor) {
  for (const Part& part : {ring_part(), bracket_part()}) {
    const auto all = prepared(part), one = prepared(part, "search: {enough: 1}");
    for (std::uint64_t seed = 71; seed <= 73; ++seed) {
      const HeapScene scene = make_scene(part, HeapOptions(), Seed{seed}, camera_above(0.6));
      const auto first = one->estimate(scene.view, Seed{1}).estimates;
      ASSERT_FALSE(first.empty()) << part.name << " seed " << seed;
      EXPECT_LT(first.size(), all->estimate(scene.view, Seed{1}).estimates.size()) << part.name << " seed " << seed;
      EXPECT_TRUE(right_for_one(part, scene, first[0].X_CP)) << part.name << " seed " << seed;
    }
  }
}

TEST(Ppf, EnoughThatIsNotThereGivesWhatIs) {
  const Part ring = ring_part();
  HeapOptions options;
  options.count = 2;
  const HeapScene scene = make_scene(ring, options, Seed{74}, camera_above(0.6));
  const auto found = prepared(ring, "search: {enough: 9}")->estimate(scene.view, Seed{1}).estimates;
  ASSERT_FALSE(found.empty());
  EXPECT_LE(found.size(), 2u);
  for (const PoseEstimate& e : found) EXPECT_TRUE(right_for_one(ring, scene, e.X_CP));
}

/// Rings, and one of another size is looked for.
TEST(Ppf, DoubtfulPosesOfAPartThatIsNotPlainlyThereAreTakenBack) {
  const HeapScene scene = make_scene(ring_part(), HeapOptions(), Seed{75}, camera_above(0.6));
  SymmetrySpec symmetry;
  symmetry.type = "revolution";
  symmetry.flip = true;
  const Part ring = part_from("other ring", ring_mesh(0.035, 0.045, 0.016), symmetry);
  const std::string open =
      "least_score: 0, least_quality: 0.3, least_explained: 0.1, least_pixels: 40, largest_leak: 1, largest_side_leak: "
      "1, least_own: 0.3";
  const auto with = [&](double presence) {
    const std::string yaml = "accept: {" + open + ", least_presence: " + std::to_string(presence) + "}";
    return prepared(ring, yaml)->estimate(scene.view, Seed{1});
  };
  const EstimateResult all = with(0);
  ASSERT_FALSE(all.estimates.empty());
  double absent = 1;
  for (const PoseEstimate& e : all.estimates) absent *= 1 - (e.ambiguous ? 2 : 1) * e.score;
  ASSERT_GT(absent, 1e-5);
  ASSERT_LT(absent, 1 - 1e-5);
  EXPECT_EQ(with(1 - absent - 2e-6).estimates.size(), all.estimates.size());
  const EstimateResult none = with(1 - absent + 2e-6);
  EXPECT_TRUE(none.estimates.empty());
  EXPECT_EQ(none.status, EstimateStatus::kNothingFound);
  EXPECT_NE(none.message.find("least_presence"), std::string::npos) << none.message;
}

TEST(Ppf, ASensorWithoutNoiseHasScoresThatStillTellPosesApart) {
  HeapOptions options;
  options.noise = false;
  const Part bracket = bracket_part();
  const HeapScene scene = make_scene(bracket, options, Seed{76}, camera_above(0.6));
  const auto found = prepared(bracket, "accept: {least_score: 0}")->estimate(scene.view, Seed{1}).estimates;
  ASSERT_FALSE(found.empty());
  for (const PoseEstimate& e : found) {
    EXPECT_GT(e.score, 0);
    EXPECT_LT(e.score, 1);
  }
}

}  // namespace
}  // namespace binpick

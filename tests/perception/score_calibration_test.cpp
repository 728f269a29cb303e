#include "perception/score_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "perception/pose_estimator.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

/// A pose that everything speaks for.
ScoreFeatures good() {
  return {1, 3.5, 0.02, 1, 3.1, 0.02, 0.02, 0, -2.5, 0.02, 0.7, 0.1, -0.2, 0, 0.2, -2, -2, 0, 0, -0.3, -1.9};
}

TEST(Score, LiesBetweenZeroAndOneAndIsHalvedWhereTwoPosesLookAlike) {
  EXPECT_EQ(score_feature_names().size(), kScoreFeatures);
  EXPECT_EQ(std::set<std::string>(score_feature_names().begin(), score_feature_names().end()).size(), kScoreFeatures);
  const double clear = calibrated_score(good(), false);
  EXPECT_GT(clear, 0.9);
  EXPECT_LT(clear, 1);
  EXPECT_DOUBLE_EQ(calibrated_score(good(), true), clear / 2);
}

TEST(Score, FallsWithContradictionsLeaksAndOverlap) {
  const double clear = calibrated_score(good(), false);
  ScoreFeatures worse = good();
  worse[1] = 0.7;  // half of what can be judged contradicts
  EXPECT_LT(calibrated_score(worse, false), clear);
  worse = good();
  worse[2] = 0.6;  // the surface goes on at six tenths of the outline
  EXPECT_LT(calibrated_score(worse, false), clear);
  worse = good();
  worse[7] = 0.3;  // three tenths of it inside another pose
  EXPECT_LT(calibrated_score(worse, false), clear);
}

double log_odds(const ScoreFeatures& features) {
  const double p = calibrated_score(features, false);
  return std::log(p / (1 - p));
}

TEST(Score, ContradictionsTellMoreUnderAQuietSensor) {
  const auto drop = [](double noise) {
    ScoreFeatures clean = good(), ragged = good();
    clean[20] = ragged[20] = noise;
    ragged[1] = 1.2;  // a quarter of what can be judged contradicts
    return log_odds(clean) - log_odds(ragged);
  };
  EXPECT_GT(drop(-1.9), 1.3 * drop(-1.5));
}

TEST(Score, TermsAreTheFeaturesAndTheirProductsWithTheNoise) {
  ScoreFeatures f = good();
  f[20] = -1.6;  // the usual noise: every product vanishes
  const ScoreTerms usual = score_terms(f);
  for (std::size_t k = 0; k < kScoreFeatures; ++k) EXPECT_DOUBLE_EQ(usual[k], f[k]) << k;
  for (std::size_t k = kScoreFeatures; k < kScoreTerms; ++k) EXPECT_NEAR(usual[k], 0, 1e-12) << k;
  f[20] = -1.1;
  const ScoreTerms noisy = score_terms(f);
  EXPECT_NEAR(noisy[kScoreFeatures], 0.5 * f[1], 1e-12);    // the first product is that of the quality
  EXPECT_NEAR(noisy[kScoreTerms - 1], 0.5 * f[19], 1e-12);  // and the last that of the part's size
}

TEST(Score, CornersDeviateByTheTranslationAndByTheTurnTimesTheLever) {
  const Eigen::AlignedBox3f box(Eigen::Vector3f(-0.03f, -0.04f, 0), Eigen::Vector3f(0.03f, 0.04f, 0));
  Matrix6d covariance = Matrix6d::Identity() * 1e-16;
  covariance.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() * 1e-6;  // 1 mm each way
  EXPECT_NEAR(corner_deviation(covariance, box, {}), std::sqrt(3.0) * 1e-3, 1e-6);
  covariance = Matrix6d::Identity() * 1e-16;
  covariance(5, 5) = 1e-4;  // 0.01 rad about z, corners 50 mm from it
  EXPECT_NEAR(corner_deviation(covariance, box, {}), 0.01 * 0.05, 1e-6);
  EXPECT_LT(corner_deviation(covariance, box, symmetry_twists(ring_part().symmetry)), 1e-5);  // nothing to know there
}

TEST(Score, OnlyWhatIsLikelyEnoughIsReturned) {
  const Part ring = ring_part();
  const auto estimator = make_estimator("ppf");
  estimator->prepare(std::span<const Part>(&ring, 1));
  const HeapScene scene = make_scene(ring, HeapOptions(), Seed{71}, camera_above(0.6));
  for (const PoseEstimate& e : estimator->estimate(scene.view, Seed{1}).estimates) {
    EXPECT_GE(e.score, e.ambiguous ? 0.175 : 0.35);
    EXPECT_LE(e.score, 1);
  }
}

// With the bare number of pixels alone, a third of such parts was thrown away, found though they were.
TEST(Score, APartOfThirtyPixelsIsReturnedAsALargeOneIs) {
  SymmetrySpec symmetry;
  symmetry.type = "revolution";
  symmetry.flip = true;
  const Part nut = part_from("nut", ring_mesh(0.009, 0.019, 0.016), symmetry);
  const auto estimator = make_estimator("ppf");
  estimator->prepare(std::span<const Part>(&nut, 1));
  HeapOptions options;
  options.sigma_px = 0.04;
  options.bias_px = 0;
  int visible = 0, returned = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const HeapScene scene = make_scene(nut, options, Seed{seed}, camera_above(0.6));
    const std::vector<PoseEstimate> found = estimator->estimate(scene.view, Seed{1}).estimates;
    for (const Instance& instance : scene.instances) {
      if (instance.visible_fraction < 0.7) continue;
      ++visible;
      const Pose X_CP = scene.X_WC.inverse() * instance.X_WP;
      returned += std::any_of(found.begin(), found.end(), [&](const PoseEstimate& e) {
        return (e.X_CP.translation() - X_CP.translation()).norm() < 0.0035;
      });
    }
  }
  EXPECT_GE(visible, 20);
  EXPECT_GE(returned, visible - 1);
}

}  // namespace
}  // namespace binpick

// Matching estimates to the truth: the counts behind recall and precision.
#include "evaluation/matching.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/evaluation/example_parts.hpp"

namespace binpick {
namespace {

using examples::moved_to;

/// `count` boxes in a row, 0.2 m apart, all in full view, and a camera that looks down from above.
GroundTruth row_of_boxes(std::size_t count) {
  GroundTruth truth;
  for (std::size_t i = 0; i < count; ++i) {
    truth.instances.push_back({0, i, moved_to(0.2 * static_cast<double>(i), 0, 0.1), 1.0, 1000});
  }
  truth.X_WC = moved_to(0, 0, 0.6) * examples::turn(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), M_PI);
  return truth;
}

/// An estimate off by `offset` along x from instance i of the row.
PoseEstimate estimate_of(const GroundTruth& truth, std::size_t i, double score, double offset = 0) {
  PoseEstimate estimate;
  estimate.part = truth.instances[i].part;
  estimate.score = score;
  estimate.X_CP = truth.X_WC.inverse() * moved_to(offset, 0, 0) * truth.instances[i].X_WP;
  return estimate;
}

PoseCheck check(const std::vector<PoseEstimate>& estimates, const GroundTruth& truth,
                const std::vector<Part>& parts = {examples::box()}) {
  EstimateResult result;
  result.estimates = estimates;
  return check_poses(result, truth.X_WC, truth, parts);
}

TEST(Matching, TruthAsEstimateScoresExactlyOne) {
  const std::vector<Part> parts = examples::all();
  GroundTruth truth;
  std::vector<PoseEstimate> estimates;
  for (std::size_t i = 0; i < 20; ++i) {
    Rng rng = Seed{20261124}.child("truth").rng().at(i);
    truth.instances.push_back({i % parts.size(), i, examples::random_pose(rng), 1.0, 1000});
    PoseEstimate estimate;
    estimate.part = i % parts.size();
    estimate.X_CP = truth.instances[i].X_WP * examples::random_member(parts[estimate.part].symmetry, rng);
    estimates.push_back(estimate);
  }
  const PoseCheck all = check(estimates, truth, parts);
  EXPECT_EQ(all.visible, 20u);
  EXPECT_EQ(all.found, 20u);
  EXPECT_EQ(all.found_tight, 20u);
  EXPECT_EQ(all.found_2mm, 20u);
  EXPECT_EQ(all.counted, 20u);
  EXPECT_EQ(all.right, 20u);
  for (const MatchedEstimate& estimate : all.estimates) {
    EXPECT_EQ(estimate.instance, estimate.estimate);
    EXPECT_LT(estimate.error.mssd, 1e-7);
  }
}

TEST(Matching, TheBelievedCameraPlacesTheEstimates) {
  const GroundTruth truth = row_of_boxes(1);
  EstimateResult result;
  result.estimates = {estimate_of(truth, 0, 1)};
  const std::vector<Part> parts = {examples::box()};
  const Pose X_WC_believed = moved_to(0.003, 0, 0) * truth.X_WC;  // a hand-eye error of 3 mm
  const PoseCheck off = check_poses(result, X_WC_believed, truth, parts);
  EXPECT_NEAR(off.estimates[0].error.translation, 0.003, 1e-12);
}

// The box's diameter is 98.99 mm: right below 9.9 mm, tight below 4.95 mm.
TEST(Matching, ThresholdsAreStrictAndSeparate) {
  const GroundTruth truth = row_of_boxes(1);
  const double diameter = examples::box().diameter;
  EXPECT_NEAR(diameter, std::sqrt(0.08 * 0.08 + 0.05 * 0.05 + 0.03 * 0.03), 1e-12);
  const auto judged = [&](double offset) { return check({estimate_of(truth, 0, 1, offset)}, truth).estimates[0]; };
  EXPECT_TRUE(judged(0.0019).right_2mm);
  EXPECT_FALSE(judged(0.0021).right_2mm);
  EXPECT_TRUE(judged(0.0499 * diameter).right_tight);
  EXPECT_FALSE(judged(0.0501 * diameter).right_tight);
  EXPECT_TRUE(judged(0.0999 * diameter).right);
  EXPECT_FALSE(judged(0.1001 * diameter).right);
}

TEST(Matching, DuplicatesAreWrong) {
  const GroundTruth truth = row_of_boxes(2);
  const PoseCheck twice = check({estimate_of(truth, 0, 0.9), estimate_of(truth, 0, 0.8, 0.001)}, truth);
  EXPECT_EQ(twice.visible, 2u);
  EXPECT_EQ(twice.found, 1u);
  EXPECT_EQ(twice.counted, 2u);
  EXPECT_EQ(twice.right, 1u);
  EXPECT_TRUE(twice.estimates[0].right);
  EXPECT_FALSE(twice.estimates[1].right);
  EXPECT_EQ(twice.estimates[1].instance, 0u);  // the nearest, though taken
  EXPECT_NEAR(twice.estimates[1].error.mssd, 0.001, 1e-12);
}

// The better score chooses first, even when the worse one is nearer.
TEST(Matching, ScoreDecidesWhoComesFirst) {
  const GroundTruth truth = row_of_boxes(1);
  const PoseCheck pair = check({estimate_of(truth, 0, 0.1), estimate_of(truth, 0, 0.9, 0.008)}, truth);
  EXPECT_FALSE(pair.estimates[0].right);
  EXPECT_TRUE(pair.estimates[1].right);
  // At 2 mm the high score has nothing to take, and the other is right.
  EXPECT_TRUE(pair.estimates[0].right_2mm);
  EXPECT_FALSE(pair.estimates[1].right_2mm);
  EXPECT_EQ(pair.found_2mm, 1u);
}

TEST(Matching, AnEstimateTakesTheNearerOfTwo) {
  GroundTruth truth = row_of_boxes(2);
  truth.instances[1].X_WP = moved_to(0.006, 0, 0) * truth.instances[0].X_WP;
  const PoseCheck pair = check({estimate_of(truth, 0, 0.9, 0.005), estimate_of(truth, 0, 0.8, 0.0045)}, truth);
  EXPECT_EQ(pair.estimates[0].instance, 1u);
  EXPECT_EQ(pair.estimates[1].instance, 0u);  // the nearer is taken; the other is within reach
  EXPECT_EQ(pair.right, 2u);
  EXPECT_EQ(check({estimate_of(truth, 0, 0.9, 0.001)}, truth).estimates[0].instance, 0u);
}

// Whatever is wrong is reported against the instance with the least MSSD of all.
TEST(Matching, WrongEstimatesAreHeldAgainstTheNearest) {
  const std::vector<Part> parts = {examples::bracket(), examples::disc()};
  int wrong = 0;
  for (std::uint64_t i = 0; i < 30; ++i) {
    Rng rng = Seed{20261124}.child("nearest").rng().at(i);
    GroundTruth truth;
    for (std::size_t k = 0; k < 10; ++k) {
      Pose X_WP = examples::random_pose(rng);
      X_WP.translation() *= 0.3;
      truth.instances.push_back({k % 2, k, X_WP, 1.0, 100});
    }
    PoseEstimate estimate;
    estimate.part = i % 2;
    estimate.X_CP = examples::random_pose(rng);
    estimate.X_CP.translation() *= 0.3;
    const MatchedEstimate judged = check({estimate}, truth, parts).estimates[0];
    wrong += judged.right ? 0 : 1;
    double least = 1e9;
    for (const GroundTruth::Instance& instance : truth.instances) {
      if (instance.part != estimate.part) continue;
      least = std::min(least, pose_error(estimate.X_CP, instance.X_WP, parts[estimate.part]).mssd);
    }
    EXPECT_EQ(judged.error.mssd, least) << "item " << i;
  }
  EXPECT_GT(wrong, 20);
}

// For a part below 20 mm, 2 mm is more than 0.1 diameter.
TEST(Matching, TwoMillimetresOfASmallPart) {
  const Part small = examples::part_of("small", mesh_of(Primitive::box({0.01, 0.002, 0.002})));
  const GroundTruth truth = row_of_boxes(1);
  const PoseCheck one = check({estimate_of(truth, 0, 1, 0.0015)}, truth, {small});
  EXPECT_FALSE(one.estimates[0].right);
  EXPECT_TRUE(one.estimates[0].right_2mm);
  EXPECT_EQ(one.found, 0u);
  EXPECT_EQ(one.found_2mm, 1u);
}

TEST(Matching, HiddenInstancesCountNeitherWay) {
  GroundTruth truth = row_of_boxes(4);
  truth.instances[1].visible_fraction = 0.09;
  truth.instances[2].visible_fraction = 0.3;
  truth.instances[3].visible_fraction = 0.5;
  const PoseCheck all =
      check({estimate_of(truth, 0, 0.9), estimate_of(truth, 1, 0.8), estimate_of(truth, 2, 0.7)}, truth);
  EXPECT_EQ(all.visible, 2u);  // 1.0 and 0.5
  EXPECT_EQ(all.found, 1u);    // 0.3 is right, but not asked for
  EXPECT_EQ(all.counted, 2u);  // the hidden one is ignored
  EXPECT_EQ(all.right, 2u);
  EXPECT_TRUE(all.estimates[1].ignored);
  EXPECT_FALSE(all.estimates[2].ignored);
}

TEST(Matching, ATenthVisibleIsNotHidden) {
  GroundTruth truth = row_of_boxes(2);
  truth.instances[0].visible_fraction = 0.1;
  truth.instances[1].visible_fraction = 0.4999;
  const PoseCheck both = check({estimate_of(truth, 0, 0.9), estimate_of(truth, 1, 0.8)}, truth);
  EXPECT_EQ(both.counted, 2u);
  EXPECT_EQ(both.right, 2u);
  EXPECT_EQ(both.visible, 0u);
  EXPECT_EQ(both.found, 0u);
}

// A nearly hidden instance excuses one estimate, not two.
TEST(Matching, ASecondEstimateOfAHiddenInstanceIsWrong) {
  GroundTruth truth = row_of_boxes(1);
  truth.instances[0].visible_fraction = 0.05;
  const PoseCheck twice = check({estimate_of(truth, 0, 0.9), estimate_of(truth, 0, 0.8)}, truth);
  EXPECT_EQ(twice.counted, 1u);
  EXPECT_EQ(twice.right, 0u);
}

// Where a hidden and a visible instance are both within reach, the visible one is served first, though it is farther.
TEST(Matching, VisibleInstancesGoFirst) {
  GroundTruth truth = row_of_boxes(2);
  truth.instances[1].X_WP = moved_to(0.004, 0, 0) * truth.instances[0].X_WP;
  truth.instances[0].visible_fraction = 0.1;
  truth.instances[1].visible_fraction = 0.0999;
  const PoseCheck one = check({estimate_of(truth, 0, 0.9, 0.003)}, truth);
  EXPECT_EQ(one.estimates[0].instance, 0u);
  EXPECT_FALSE(one.estimates[0].ignored);
  EXPECT_EQ(one.right, 1u);
}

TEST(Matching, AnotherPartIsNoMatch) {
  const GroundTruth truth = row_of_boxes(1);
  PoseEstimate estimate = estimate_of(truth, 0, 0.9);
  estimate.part = 1;
  const PoseCheck one = check({estimate}, truth, {examples::box(), examples::bracket()});
  EXPECT_FALSE(one.estimates[0].right);
  EXPECT_FALSE(one.estimates[0].instance.has_value());
  EXPECT_TRUE(std::isnan(one.estimates[0].error.mssd));
  EXPECT_EQ(one.counted, 1u);
}

TEST(Matching, NothingSeenAndNothingThere) {
  const GroundTruth truth = row_of_boxes(3);
  const PoseCheck blind = check({}, truth);
  EXPECT_EQ(blind.visible, 3u);
  EXPECT_EQ(blind.found, 0u);
  EXPECT_EQ(blind.counted, 0u);
  const PoseCheck ghost = check({estimate_of(truth, 0, 0.5)}, GroundTruth{});
  EXPECT_EQ(ghost.visible, 0u);
  EXPECT_EQ(ghost.counted, 1u);
  EXPECT_EQ(ghost.right, 0u);
}

TEST(Matching, PosesThatAreNoNumbersAreWrong) {
  const GroundTruth truth = row_of_boxes(1);
  PoseEstimate estimate = estimate_of(truth, 0, std::nan(""));
  estimate.X_CP.translation().x() = std::nan("");
  const PoseCheck broken = check({estimate, estimate_of(truth, 0, 0.5)}, truth);
  EXPECT_FALSE(broken.estimates[0].right);
  EXPECT_TRUE(broken.estimates[1].right);
}

// Neither the order of the estimates nor that of the instances changes any count.
TEST(Matching, OrderDoesNotMatter) {
  const std::vector<Part> parts = {examples::disc(), examples::bracket()};
  for (std::uint64_t i = 0; i < 20; ++i) {
    Rng rng = Seed{20261124}.child("order").rng().at(i);
    GroundTruth truth;
    std::vector<PoseEstimate> estimates;
    for (std::size_t k = 0; k < 12; ++k) {
      truth.instances.push_back({k % 2, k, examples::random_pose(rng), rng.uniform(), 100});
      for (int copy = 0; copy < 2; ++copy) {
        PoseEstimate estimate;
        estimate.part = k % 2;
        estimate.score = rng.uniform();
        estimate.X_CP = moved_to(rng.uniform(0, 0.015), 0, 0) * truth.instances[k].X_WP;
        estimates.push_back(estimate);
      }
    }
    const PoseCheck before = check(estimates, truth, parts);
    rng.shuffle(estimates);
    rng.shuffle(truth.instances);
    const PoseCheck after = check(estimates, truth, parts);
    EXPECT_EQ(before.visible, after.visible) << "item " << i;
    EXPECT_EQ(before.found, after.found) << "item " << i;
    EXPECT_EQ(before.found_tight, after.found_tight) << "item " << i;
    EXPECT_EQ(before.found_2mm, after.found_2mm) << "item " << i;
    EXPECT_EQ(before.counted, after.counted) << "item " << i;
    EXPECT_EQ(before.right, after.right) << "item " << i;
    EXPECT_GT(before.right, 0u) << "item " << i;
    EXPECT_LT(before.right, before.counted) << "item " << i;
  }
}

}  // namespace
}  // namespace binpick

// Scores of a data set whose scores are known: the truth, its twins, the truth disturbed.
#include "evaluation/bop_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/evaluation/bop_dataset.hpp"

namespace binpick {
namespace {

class BopScores : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new examples::Folder("bop_score");
    examples::write_dataset(folder_->path("set"));
    dataset_ = new BopDataset(read_bop_dataset(folder_->path("set")));
  }
  static void TearDownTestSuite() {
    delete dataset_;
    delete folder_;
  }
  static BopEstimate& best_of(std::vector<BopEstimate>& estimates, int object) {
    return *std::max_element(estimates.begin(), estimates.end(), [&](const BopEstimate& a, const BopEstimate& b) {
      return std::pair(a.object == object, a.score) < std::pair(b.object == object, b.score);
    });
  }
  static BopScoreOptions without_vsd(std::size_t most = kMostPerImage) {
    BopScoreOptions options;
    options.with_vsd = false;
    options.most_per_image = most;
    return options;
  }
  static std::vector<BopEstimate> truth() {
    return examples::truth_as_estimates(*dataset_, [](const Pose& X, int) { return X; });
  }
  /// Every part turned by a random member of its own group.
  static std::vector<BopEstimate> twins() {
    Rng rng = Seed{11}.rng();
    return examples::truth_as_estimates(*dataset_, [&](const Pose& X, int object) {
      for (const auto& [id, part] : examples::some_objects())
        if (id == object) return Pose(X * examples::random_member(part.symmetry, rng));
      return X;
    });
  }
  static std::vector<BopEstimate> shifted(double by) {
    Rng rng = Seed{12}.rng();
    return examples::truth_as_estimates(*dataset_, [&](Pose X, int) {
      X.translation() += by * rng.unit_vector();
      return X;
    });
  }
  static examples::Folder* folder_;
  static BopDataset* dataset_;
};
examples::Folder* BopScores::folder_ = nullptr;
BopDataset* BopScores::dataset_ = nullptr;

TEST_F(BopScores, TheTruthScoresOne) {
  for (const SymmetrySearch search : {SymmetrySearch::kExact, SymmetrySearch::kToolkit}) {
    const BopScore score = score_bop(*dataset_, truth(), {search, {}, true, kMostPerImage});
    EXPECT_EQ(score.images, 2u);
    EXPECT_GT(score.targets, 15u);
    EXPECT_EQ(score.elsewhere, 0u);
    EXPECT_EQ(score.ar_vsd, 1.0);
    EXPECT_EQ(score.ar_mssd, 1.0);
    EXPECT_EQ(score.ar_mspd, 1.0);
    EXPECT_EQ(score.ar, 1.0);
    EXPECT_EQ(score.ap_mssd, 1.0);
    EXPECT_EQ(score.ap_mspd, 1.0);
    EXPECT_EQ(score.ap_mssd_mm, 1.0);
    EXPECT_EQ(score.bulk.ap, 1.0);
    EXPECT_EQ(score.time, 0.25);
    EXPECT_EQ(score.curve.back().recall, 1.0);
    for (const PairErrors& pair : score.matched.pairs) EXPECT_LT(pair.mssd, 1e-9);
    for (const double cus : score.matched.cus) EXPECT_EQ(cus, 0);
  }
}

TEST_F(BopScores, TwinsScoreOneOnWhatKnowsSymmetry) {
  const BopScore score = score_bop(*dataset_, twins(), {});
  EXPECT_EQ(score.ar_mssd, 1.0);
  EXPECT_EQ(score.ar_mspd, 1.0);
  EXPECT_EQ(score.ap_mssd, 1.0);
  EXPECT_EQ(score.ap_mspd, 1.0);
  EXPECT_EQ(score.ap_mssd_mm, 1.0);
  EXPECT_EQ(score.bulk.ap, 1.0);
  double turned = 0;
  for (const PairErrors& pair : score.matched.pairs) turned = std::max(turned, pair.rotation);
  EXPECT_GT(turned, 1);  // they are twins, not the truth
}

// MSSD of a shift is its length, whatever the symmetry.
TEST_F(BopScores, AShiftLosesTheThresholdsBelowIt) {
  const BopScore five = score_bop(*dataset_, shifted(0.005), {});
  EXPECT_NEAR(five.ap_mssd_mm, 0.8, 1e-12);  // 6 .. 20 mm
  EXPECT_LT(five.ar_vsd.value(), 1);
  const BopScore one = score_bop(*dataset_, shifted(0.001), {});
  EXPECT_NEAR(one.ap_mssd_mm, 1.0, 1e-12);
  double share = 0;  // of the thresholds 0.05 d .. 0.5 d that 0.009 m passes, over the three objects' targets
  const BopScore nine = score_bop(*dataset_, shifted(0.009), {});
  std::size_t targets = 0;
  for (const auto& [id, object] : dataset_->objects) {
    const double passed = 10 - std::floor(0.009 / (0.05 * object.part.diameter));
    share += passed / 10 * static_cast<double>(nine.objects.at(id).targets);
    targets += nine.objects.at(id).targets;
  }
  EXPECT_EQ(targets, nine.targets);
  EXPECT_NEAR(nine.ar_mssd, share / static_cast<double>(targets), 1e-9);
}

TEST_F(BopScores, AMissingEstimateIsAMissAndAWrongOneCosts) {
  std::vector<BopEstimate> estimates = truth();
  const BopScore before = score_bop(*dataset_, estimates, without_vsd());
  EXPECT_FALSE(before.ar_vsd || before.ar);
  // The best box is left out ..
  BopEstimate& best = best_of(estimates, 1);
  const int scene = best.scene, image = best.image;
  best.object = 77;
  BopScore score = score_bop(*dataset_, estimates, without_vsd());
  EXPECT_EQ(score.elsewhere, 1u);
  EXPECT_NEAR(score.ar_mssd, 1 - 1.0 / static_cast<double>(score.targets), 1e-12);
  EXPECT_LT(score.ap_mssd, 1);
  EXPECT_EQ(score.objects.at(2).ap_mssd, 1.0);
  // .. and something wrong stands before all others: localisation does not mind as long as there is room.
  estimates = truth();
  BopEstimate wrong = best_of(estimates, 1);
  wrong.scene = scene, wrong.image = image, wrong.score = 2;
  wrong.X_CO.translation().z() += 0.5;
  estimates.push_back(wrong);
  score = score_bop(*dataset_, estimates, without_vsd());
  EXPECT_LT(score.objects.at(1).ap_mssd, 1);
  EXPECT_LT(score.bulk.ap, 1);
  EXPECT_EQ(score.calibration.outside, 1u);
}

TEST_F(BopScores, OnlyTheBestOfAnImageAreDetections) {
  const BopScore score = score_bop(*dataset_, truth(), without_vsd(3));
  EXPECT_EQ(score.ar_mssd, 1.0);
  EXPECT_LT(score.ap_mssd, 1.0);
  EXPECT_EQ(score.matched.pairs.size(), 6u);
}

TEST_F(BopScores, TheJsonHasTheToolkitsNames) {
  const nlohmann::json json = nlohmann::json::parse(bop_score_json(score_bop(*dataset_, shifted(0.005), {})));
  EXPECT_NEAR(json["bop25_mAP_mm"].get<double>(), 0.8, 1e-12);
  EXPECT_EQ(json["bop25_mAP"], json["bop24_mAP_mssd"]);
  EXPECT_NEAR(json["bop19_average_recall"].get<double>() * 3,
              json["bop19_average_recall_vsd"].get<double>() + json["bop19_average_recall_mssd"].get<double>() +
                  json["bop19_average_recall_mspd"].get<double>(),
              1e-12);
  EXPECT_NEAR(json["errors_of_right_estimates"]["mssd"]["median"].get<double>(), 0.005, 1e-6);
  EXPECT_EQ(json["schema"], 1);
}

}  // namespace
}  // namespace binpick

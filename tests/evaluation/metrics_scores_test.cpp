// Recall, precision and what is made of them, on images small enough to count by hand.
#include "evaluation/metrics_scores.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "evaluation/metrics_bulk.hpp"
#include "evaluation/metrics_curves.hpp"

namespace binpick {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

const ErrorTable& mssd_of(const ImageErrors& image) { return image.mssd; }
const ErrorTable& surface_of(const ImageErrors& image) { return image.surface; }

/// Instances of object 1, all visible; errors[estimate][instance] serves as mssd and as surface.
ImageErrors image_of(const std::vector<double>& scores, const std::vector<std::vector<double>>& errors,
                     std::size_t instances) {
  ImageErrors image;
  image.instances.assign(instances, {1, 1.0, true});
  for (const double score : scores) image.estimates.push_back({1, score, true, true});
  image.mssd = image.surface = ErrorTable(scores.size(), instances);
  for (std::size_t e = 0; e < scores.size(); ++e)
    for (std::size_t i = 0; i < instances; ++i) image.mssd.at(e, i) = image.surface.at(e, i) = errors[e][i];
  return image;
}

TEST(Matching, TheBetterScoreChoosesFirst) {
  // Both estimates are nearest to instance 0; the better one takes it, the other one has to be content with 1.
  const ImageErrors image = image_of({0.5, 0.9}, {{0.1, 0.3}, {0.2, 0.25}}, 2);
  EXPECT_EQ(match_greedily(image, image.mssd, 1.0, Task::kDetection), (Matches{1, 0}));
  EXPECT_EQ(match_greedily(image, image.mssd, 0.3, Task::kDetection), (Matches{std::nullopt, 0}));  // strictly below
}

TEST(Matching, LocalisationLooksAtTargetsAndAtTheBestOnly) {
  ImageErrors image = image_of({0.5, 0.9}, {{0.1, 0.3}, {0.2, 0.25}}, 2);
  image.instances[0].target = false;
  EXPECT_EQ(match_greedily(image, image.mssd, 1.0, Task::kLocalisation), (Matches{std::nullopt, 1}));
  image.estimates[1].asked = false;
  EXPECT_EQ(match_greedily(image, image.mssd, 1.0, Task::kLocalisation), (Matches{1, std::nullopt}));
  EXPECT_EQ(match_greedily(image, image.mssd, 1.0, Task::kDetection), (Matches{1, 0}));
}

TEST(Matching, ObjectsAreKeptApart) {
  ImageErrors image = image_of({0.9}, {{0.0}}, 1);
  image.estimates[0].object = 2;
  EXPECT_EQ(match_greedily(image, image.mssd, 1.0, Task::kDetection), Matches{std::nullopt});
}

TEST(AverageRecall, CountsTargetsOverImages) {
  const std::vector<ImageErrors> images = {image_of({0.9, 0.8}, {{0.10, kInf}, {kInf, 0.35}}, 2),
                                           image_of({0.7}, {{0.06, kInf, kInf}}, 3)};
  EXPECT_DOUBLE_EQ(localisation_recall(images, mssd_of, 0.05), 0);
  EXPECT_DOUBLE_EQ(localisation_recall(images, mssd_of, 0.08), 1.0 / 5);
  EXPECT_DOUBLE_EQ(localisation_recall(images, mssd_of, 0.5), 3.0 / 5);
  // 0.05: 0; 0.10: 1, 0.15 .. 0.35: 2 (0.35 is not below 0.35, but for rounding), 0.40 .. 0.50: 3
  const double at_35 = localisation_recall(images, mssd_of, bop_thresholds()[6]);
  EXPECT_NEAR(average_recall(images, mssd_of, bop_thresholds()), (0 + 0.2 + 4 * 0.4 + at_35 + 3 * 0.6) / 10, 1e-12);
}

// The toolkit's own example: right are the 2nd, 3rd and 5th of six estimates, of six targets.
TEST(AveragePrecision, TheBestPrecisionAt101Recalls) {
  const std::vector<Judged> judged = {{6, false}, {5, true}, {4, true}, {3, false}, {2, true}, {1, false}};
  EXPECT_NEAR(interpolated_precision(judged, 6), (34 * (2.0 / 3) + 17 * 0.6) / 101, 1e-12);
  EXPECT_NEAR(interpolated_precision({{1, true}}, 1), 1, 1e-12);
  EXPECT_EQ(interpolated_precision({}, 3), 0);
}

TEST(AveragePrecision, HiddenInstancesCountNeitherWay) {
  ImageErrors image = image_of({0.9, 0.8, 0.7}, {{0.0, kInf}, {kInf, 0.0}, {kInf, kInf}}, 2);
  image.instances[1].visible = 0.09;
  const std::vector<ImageErrors> images = {image};
  const auto [judged, targets] = detections(images, mssd_of, 0.1);
  EXPECT_EQ(targets, 1u);
  ASSERT_EQ(judged.size(), 2u);  // the one at the hidden instance is left out
  EXPECT_TRUE(judged[0].right);
  EXPECT_FALSE(judged[1].right);
}

TEST(AveragePrecision, IsTheMeanOverObjectsWithTargets) {
  ImageErrors image = image_of({0.9, 0.8, 0.7}, {{0.0, kInf, kInf}, {kInf, 0.5, kInf}, {kInf, kInf, 0.0}}, 3);
  image.instances[1].object = image.estimates[1].object = 2;
  image.instances[2].object = image.estimates[2].object = 3;
  image.instances[2].visible = 0.05;
  const std::vector<ImageErrors> images = {image};
  EXPECT_EQ(detection_precision(images, mssd_of, {0.1}), (std::map<int, std::vector<double>>{{1, {1.0}}, {2, {0.0}}}));
  EXPECT_DOUBLE_EQ(mean_average_precision(detection_precision(images, mssd_of, {0.1, 0.6})),
                   (1 + 0.5) / 2);  // object 2 at 0.6 only
}

/// An image of data/bop_scores.json, as bop_score prepares it.
ImageErrors image_of(const nlohmann::json& json, const nlohmann::json& diameters) {
  ImageErrors image;
  std::map<int, int> left, asked;
  for (const auto& [object, count] : json["counts"].items()) left[std::stoi(object)] = asked[std::stoi(object)] = count;
  for (const auto& one : json["instances"]) image.instances.push_back({one["object"], one["visible"], false});
  std::vector<std::size_t> order(image.instances.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return image.instances[a].visible > image.instances[b].visible;
  });
  for (const std::size_t i : order) image.instances[i].target = left[image.instances[i].object]-- > 0;
  std::vector<nlohmann::json> rows = json["estimates"];
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a["score"] > b["score"]; });
  image.mssd = image.mssd_diameter = image.mspd = ErrorTable(rows.size(), order.size());
  for (std::size_t e = 0; e < rows.size(); ++e) {
    const int object = rows[e]["object"];
    image.estimates.push_back(
        {object, rows[e]["score"], asked[object]-- > 0, diameters.contains(std::to_string(object))});
    for (const auto& [i, errors] : rows[e]["errors"].items()) {
      image.mssd.at(e, std::stoul(i)) = errors[0];
      image.mssd_diameter.at(e, std::stoul(i)) =
          errors[0].get<double>() / diameters[std::to_string(object)].get<double>();
      image.mspd.at(e, std::stoul(i)) = errors[1].get<double>() * 640 / 848;
    }
  }
  return image;
}

// Another program's scores of the same errors (the file says which).
TEST(AverageRecall, AsAnotherProgramHasIt) {
  std::ifstream file(BINPICK_SOURCE_DIR "/tests/evaluation/data/bop_scores.json");
  const nlohmann::json data = nlohmann::json::parse(file), scores = data["scores"];
  std::vector<ImageErrors> images;
  for (const nlohmann::json& image : data["images"]) images.push_back(image_of(image, data["diameters"]));
  ASSERT_EQ(images.size(), 2u);
  const TableOf diameters = [](const ImageErrors& i) -> const ErrorTable& { return i.mssd_diameter; };
  const TableOf pixels = [](const ImageErrors& i) -> const ErrorTable& { return i.mspd; };
  EXPECT_NEAR(average_recall(images, diameters, bop_thresholds()), scores["bop19_average_recall_mssd"], 1e-12);
  EXPECT_NEAR(average_recall(images, pixels, ten_steps_of(5)), scores["bop19_average_recall_mspd"], 1e-12);
  EXPECT_NEAR(mean_average_precision(detection_precision(images, diameters, bop_thresholds())),
              scores["bop24_mAP_mssd"], 1e-12);
  EXPECT_NEAR(mean_average_precision(detection_precision(images, pixels, ten_steps_of(5))), scores["bop24_mAP_mspd"],
              1e-12);
  EXPECT_NEAR(mean_average_precision(detection_precision(images, mssd_of, ten_steps_of(2))), scores["bop25_mAP_mm"],
              1e-12);
}

TEST(Bulk, DuplicatesAreWrongAndHiddenOnesCountNeitherWay) {
  // 0 and 1 both at instance 0 (1 is nearer), 2 at instance 1 which is half hidden, 3 nowhere; instance 2 is missed.
  ImageErrors scene =
      image_of({0.9, 0.8, 0.7, 0.6}, {{0.5, kInf, kInf}, {0.2, kInf, kInf}, {kInf, 0.1, kInf}, {2.0, 2.0, 2.0}}, 3);
  scene.instances[1].visible = 0.4;
  const BulkPoint all = bulk_point(scene, 0);
  EXPECT_DOUBLE_EQ(all.precision, 1.0 / 3);  // 1 right; 0 and 3 wrong; 2 neither
  EXPECT_DOUBLE_EQ(all.recall, 1.0 / 2);
  const BulkPoint first = bulk_point(scene, 0.9);  // alone, 0 is the nearest
  EXPECT_DOUBLE_EQ(first.precision, 1);
  EXPECT_DOUBLE_EQ(first.recall, 1.0 / 2);
  EXPECT_DOUBLE_EQ(bulk_point(scene, 0, 1).recall, 1);  // of the one that was asked for
  EXPECT_DOUBLE_EQ(bulk_point(scene, kInf).precision, 1);
}

TEST(Bulk, TheCurveIsTheMeanOfTheScenes) {
  const ImageErrors good = image_of({0.9, 0.5}, {{0.0, kInf}, {kInf, 0.0}}, 2);
  const ImageErrors bad = image_of({0.7}, {{kInf}}, 1);
  const std::vector<ImageErrors> scenes = {good, bad};
  const BulkScore score = bulk_score(scenes);
  // inf: p (1+1)/2, r 0; 0.9: p 1, r 1/4; 0.7: p 1/2, r 1/4; 0.5: p 1/2, r 1/2
  ASSERT_EQ(score.curve.size(), 4u);
  EXPECT_DOUBLE_EQ(score.curve[1].recall, 0.25);
  EXPECT_DOUBLE_EQ(score.curve[3].precision, 0.5);
  EXPECT_DOUBLE_EQ(score.ap, 1 * 0.25 + 0.5 * 0.25);
  EXPECT_DOUBLE_EQ(score.mean_ap, (1.0 + 0.0) / 2);
  EXPECT_DOUBLE_EQ(score.best_f1, 0.5);
  EXPECT_DOUBLE_EQ(score.recall_at_99, 0.25);
  EXPECT_DOUBLE_EQ(bulk_score(std::vector<ImageErrors>{image_of({}, {}, 0)}).ap, 1);  // nothing to find
}

TEST(Curves, PrecisionAndRecallAtEveryScore) {
  const std::vector<CurvePoint> curve = precision_recall({{0.9, true}, {0.5, false}, {0.5, true}}, 4);
  ASSERT_EQ(curve.size(), 2u);  // equal scores enter together
  EXPECT_DOUBLE_EQ(curve[0].precision, 1);
  EXPECT_DOUBLE_EQ(curve[0].recall, 0.25);
  EXPECT_DOUBLE_EQ(curve[1].precision, 2.0 / 3);
  EXPECT_DOUBLE_EQ(curve[1].recall, 0.5);
}

TEST(Curves, CalibrationOfScores) {
  const Calibration c = score_calibration({{1.0, true}, {0.95, false}, {0.25, false}, {1.5, true}});
  EXPECT_EQ(c.outside, 1u);
  ASSERT_EQ(c.bins.size(), 2u);
  EXPECT_EQ(c.bins[1].count, 2u);
  EXPECT_EQ(c.bins[1].right, 1u);
  EXPECT_DOUBLE_EQ(c.bins[1].mean_score, 0.975);
  EXPECT_NEAR(c.expected_error, (1 * 0.25 + 2 * 0.475) / 3, 1e-12);
  EXPECT_NEAR(c.brier, (0 + 0.95 * 0.95 + 0.25 * 0.25) / 3, 1e-12);
}

TEST(Curves, RecallByVisibility) {
  ImageErrors image = image_of({0.9, 0.8}, {{0.0, kInf, kInf}, {kInf, kInf, 0.0}}, 3);
  image.instances[1].visible = 0.2;
  image.instances[2].visible = 0.1;
  const std::vector<ImageErrors> images = {image};
  const std::vector<VisibilityBin> bins = recall_by_visibility(images, surface_of, 0.5, {0, 0.1, 0.3, 1});
  EXPECT_EQ(bins[0].instances, 0u);
  EXPECT_EQ(bins[1].instances, 2u);
  EXPECT_EQ(bins[1].found, 1u);
  EXPECT_EQ(bins[2].instances, 1u);  // fully visible: 1 belongs to the last bin
  EXPECT_EQ(bins[2].found, 1u);
}

}  // namespace
}  // namespace binpick

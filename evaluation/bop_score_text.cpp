#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "evaluation/bop_score.hpp"
#include "evaluation/statistics.hpp"

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1e3, kDegrees = 180 / std::numbers::pi;

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return std::string(text) + "\n";
}

std::string percent(const std::optional<double>& share) {
  char text[20] = "-";
  if (share) std::snprintf(text, sizeof text, "%.2f %%", 100 * *share);
  return text;
}

struct Column {
  const char *name, *unit;
  double factor;
  std::vector<double> values;
};

std::vector<Column> columns_of(const MatchedErrors& matched) {
  const auto each = [&](double PairErrors::*field) {
    std::vector<double> values;
    for (const PairErrors& pair : matched.pairs) values.push_back(pair.*field);
    return values;
  };
  return {{"add", "mm", kMillimetres, each(&PairErrors::add)},
          {"adi", "mm", kMillimetres, each(&PairErrors::adi)},
          {"mssd", "mm", kMillimetres, each(&PairErrors::mssd)},
          {"surface", "mm", kMillimetres, each(&PairErrors::surface)},
          {"translation", "mm", kMillimetres, each(&PairErrors::translation)},
          {"rotation_twin", "deg", kDegrees, each(&PairErrors::rotation_twin)},
          {"mspd", "px", 1, each(&PairErrors::mspd_px)},
          {"cus", "", 1, matched.cus}};
}

std::string tables(const BopScore& score) {
  std::string text = "\nRecall by visible fraction (MSSD < 0.1 diameter)\n";
  for (const VisibilityBin& bin : score.by_visibility)
    text += line("  %.1f .. %.1f  %6zu of %6zu", bin.low, bin.high, bin.found, bin.instances);
  text += "\nErrors of the right estimates (MSSD < 0.1 diameter)   median      p95\n";
  for (const Column& column : columns_of(score.matched))
    if (!column.values.empty())
      text += line("  %-14s %-4s %36.3f %8.3f", column.name, column.unit, column.factor * quantile(column.values, 0.5),
                   column.factor * quantile(column.values, 0.95));
  text += "\nScores against being right: expected calibration error " + percent(score.calibration.expected_error) +
          line(", Brier %.4f", score.calibration.brier);
  for (const Calibration::Bin& bin : score.calibration.bins)
    text += line("  score %.1f .. %.1f  mean %.3f  right %6zu of %6zu", bin.low, bin.high, bin.mean_score, bin.right,
                 bin.count);
  if (score.calibration.outside > 0) text += line("  %zu scores are no probabilities", score.calibration.outside);
  return text;
}

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json errors_json(const MatchedErrors& matched) {
  Json json = {{"count", matched.pairs.size()}};
  for (const Column& column : columns_of(matched))
    if (!column.values.empty())
      json[column.name] = {{"median", quantile(column.values, 0.5)}, {"p95", quantile(column.values, 0.95)}};
  return json;
}

Json curves_json(const BopScore& score) {
  Json json;
  json["recall_by_visibility"] = json["precision_recall"] = json["calibration"] = Json::array();
  for (const VisibilityBin& bin : score.by_visibility)
    json["recall_by_visibility"].push_back(
        {{"low", bin.low}, {"high", bin.high}, {"instances", bin.instances}, {"found", bin.found}});
  for (const CurvePoint& p : score.curve)
    json["precision_recall"].push_back({{"score", p.score}, {"precision", p.precision}, {"recall", p.recall}});
  for (const Calibration::Bin& bin : score.calibration.bins)
    json["calibration"].push_back({{"low", bin.low},
                                   {"high", bin.high},
                                   {"count", bin.count},
                                   {"right", bin.right},
                                   {"mean_score", bin.mean_score}});
  json["expected_calibration_error"] = score.calibration.expected_error;
  json["brier"] = score.calibration.brier;
  json["scores_that_are_no_probabilities"] = score.calibration.outside;
  return json;
}

}  // namespace

std::string bop_score_text(const BopScore& score) {
  std::string text = line("%zu images, %zu targets, %zu estimates (%zu of them not asked for)", score.images,
                          score.targets, score.estimates, score.elsewhere);
  text += "\n6D localisation (BOP19)\n  AR_VSD  " + percent(score.ar_vsd) + "\n  AR_MSSD " + percent(score.ar_mssd) +
          "\n  AR_MSPD " + percent(score.ar_mspd) + "\n  AR      " + percent(score.ar) + "\n";
  text += "\n6D detection (BOP24, BOP25)\n  AP_MSSD " + percent(score.ap_mssd) + "  (bop25_mAP)\n  AP_MSPD " +
          percent(score.ap_mspd) + "\n  AP      " + percent(score.ap) + "  (bop24_mAP)\n  AP_MSSD at 2 .. 20 mm " +
          percent(score.ap_mssd_mm) + "  (bop25_mAP_mm)\n";
  for (const auto& [id, one] : score.objects)
    text += line("  object %d: %zu targets, AP_MSSD %.2f %%, AP_MSPD %.2f %%, in mm %.2f %%", id, one.targets,
                 100 * one.ap_mssd, 100 * one.ap_mspd, 100 * one.ap_mssd_mm);
  text += "\nParts in bulk (Bregier et al. 2017)\n  AP " + percent(score.bulk.ap) + ", mean of the images' AP " +
          percent(score.bulk.mean_ap) + ", best F1 " + percent(score.bulk.best_f1) + ", recall at 99 % precision " +
          percent(score.bulk.recall_at_99) + "\n";
  text += tables(score);
  if (score.time) text += line("\n%.3f s an image", *score.time);
  for (const std::string& note : score.notes) text += "note: " + note + "\n";
  return text;
}

std::string bop_score_json(const BopScore& score) {
  Json json = {{"schema", 1},
               {"images", score.images},
               {"targets", score.targets},
               {"estimates", score.estimates},
               {"estimates_not_asked_for", score.elsewhere},
               {"bop19_average_recall_vsd", optional_json(score.ar_vsd)},
               {"bop19_average_recall_mssd", score.ar_mssd},
               {"bop19_average_recall_mspd", score.ar_mspd},
               {"bop19_average_recall", optional_json(score.ar)},
               {"bop24_mAP_mssd", score.ap_mssd},
               {"bop24_mAP_mspd", score.ap_mspd},
               {"bop24_mAP", score.ap},
               {"bop25_mAP", score.ap_mssd},
               {"bop25_mAP_mm", score.ap_mssd_mm},
               {"average_time_per_image", score.time.value_or(-1)}};
  json["objects"] = Json::object();
  for (const auto& [id, one] : score.objects)
    json["objects"][std::to_string(id)] = {{"targets", one.targets},
                                           {"mAP_mssd", one.ap_mssd},
                                           {"mAP_mspd", one.ap_mspd},
                                           {"mAP_mssd_mm", one.ap_mssd_mm}};
  json["bulk"] = {{"ap", score.bulk.ap},
                  {"mean_ap", score.bulk.mean_ap},
                  {"best_f1", score.bulk.best_f1},
                  {"recall_at_99_precision", score.bulk.recall_at_99}};
  json.update(curves_json(score));
  json["errors_of_right_estimates"] = errors_json(score.matched);
  json["notes"] = score.notes;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace binpick

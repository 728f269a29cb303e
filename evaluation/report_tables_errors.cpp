// Errors of right poses, axis by axis and as distributions; what a score is worth.
#include <algorithm>
#include <array>
#include <cmath>

#include "evaluation/paper_figures.hpp"
#include "evaluation/report_tables.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

/// Every estimate that is right and counts, of trials that are measurements.
std::vector<const MatchedEstimate*> right_estimates(std::span<const TrialRecord> records) {
  std::vector<const MatchedEstimate*> right;
  for (const TrialRecord& record : records) {
    if (failure_of(record)) continue;
    for (const PickRecord& pick : record.picks)
      for (const MatchedEstimate& e : pick.check.estimates)
        if (e.right && !e.ignored && std::isfinite(e.error.translation) && std::isfinite(e.error.rotation))
          right.push_back(&e);
  }
  return right;
}

template <class Value>
std::vector<double> sorted_values(const std::vector<const MatchedEstimate*>& estimates, const Value& value) {
  std::vector<double> values;
  for (const MatchedEstimate* e : estimates) values.push_back(value(*e));
  std::sort(values.begin(), values.end());
  return values;
}

ReportTable by_axis(const std::vector<const MatchedEstimate*>& right) {
  ReportTable table{
      "errors_by_axis",
      "Errors of right poses, by axis (paper: Tables 1 and 2)",
      "Absolute differences in W at the bounding-box centre, against the nearest symmetric twin. Roll and "
      "yaw of a part that lies near pitch = 90 deg lose their meaning one by one. The paper's are means of "
      "five poses, as printed.",
      {},
      {}};
  table.columns = {{"axis", "axis", -1},
                   {"unit", "unit", -1},
                   {"mean_abs", "mean |error|", 3},
                   {"median_abs", "median", 3},
                   {"p95_abs", "95 %", 3},
                   {"max_abs", "largest", 3},
                   {"paper_mean_abs", "paper, mean", 2}};
  constexpr std::array kNames = {"X", "Y", "Z", "roll", "pitch", "yaw"};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis % 3);
    const bool angle = axis >= 3;
    const std::vector<double> values = sorted_values(right, [&](const MatchedEstimate& e) {
      return angle ? text::kToDeg * e.error.abs_rpy[k] : text::kToMm * e.error.abs_xyz[k];
    });
    const double paper = angle ? paper::kMeanAbsRpyDeg[axis % 3] : paper::kMeanAbsXyzMm[axis];
    table.add({kNames[axis], angle ? "deg" : "mm", mean(values), quantile(values, 0.5), quantile(values, 0.95),
               quantile(values, 1), paper});
  }
  return table;
}

ReportTable cdf(const std::vector<const MatchedEstimate*>& right) {
  ReportTable table{"error_cdf",
                    "Distribution of errors of right poses",
                    std::to_string(right.size()) + " right poses of instances visible at least 0.1.",
                    {},
                    {}};
  table.columns = {{"share_pct", "share of poses, %", 0},
                   {"translation_mm", "translation <=, mm", 3},
                   {"rotation_deg", "rotation <=, deg", 3},
                   {"mssd_mm", "MSSD <=, mm", 3},
                   {"add_s_mm", "ADD-S <=, mm", 3}};
  if (right.empty()) return table;
  const std::array columns = {
      sorted_values(right, [](const MatchedEstimate& e) { return text::kToMm * e.error.translation; }),
      sorted_values(right, [](const MatchedEstimate& e) { return text::kToDeg * e.error.rotation; }),
      sorted_values(right, [](const MatchedEstimate& e) { return text::kToMm * e.error.mssd; }),
      sorted_values(right, [](const MatchedEstimate& e) { return text::kToMm * e.error.add_s; })};
  for (int percent = 0; percent <= 100; ++percent) {
    std::vector<TableCell> row = {double(percent)};
    for (const std::vector<double>& values : columns) row.push_back(quantile(values, percent / 100.0));
    table.add(std::move(row));
  }
  return table;
}

ReportTable calibration(std::span<const TrialRecord> records) {
  constexpr std::size_t kBins = 10;
  ReportTable table{"score_calibration",
                    "What a score is worth",
                    "Estimates that count, by their score: how many of them are right.",
                    {},
                    {}};
  table.columns = {{"score_from", "score from", 1},
                   {"score_to", "to", 1},
                   {"estimates", "estimates", 0},
                   {"right", "right", 0},
                   {"right_pct", "right, %", 1},
                   {"low_pct", "95 % from", 1},
                   {"high_pct", "to", 1}};
  std::vector<GroupCount> bins(kBins);
  for (GroupCount& bin : bins) bin.piles.resize(records.size());
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (failure_of(records[r])) continue;
    for (const PickRecord& pick : records[r].picks)
      for (const MatchedEstimate& e : pick.check.estimates) {
        if (e.ignored || !(e.score >= 0)) continue;
        ClusterCount& pile =
            bins[std::min(kBins - 1, static_cast<std::size_t>(kBins * std::min(e.score, 1.0)))].piles[r];
        pile.total += 1;
        pile.hits += e.right ? 1 : 0;
      }
  }
  for (std::size_t b = 0; b < kBins; ++b) {
    const std::vector<TableCell> rate = rate_cells(bins[b], "score", b);
    table.add({double(b) / kBins, double(b + 1) / kBins, bins[b].total(), bins[b].hits(), rate[0], rate[1], rate[2]});
  }
  return table;
}

}  // namespace

std::vector<ReportTable> error_tables(std::span<const TrialRecord> records) {
  const std::vector<const MatchedEstimate*> right = right_estimates(records);
  return {by_axis(right), cdf(right), calibration(records)};
}

}  // namespace binpick

#include "tools/bench/perception_rows.hpp"

#include <cmath>
#include <limits>

namespace binpick {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Rate rate_of(std::size_t hits, std::size_t total, const Interval& interval) {
  return {hits, total, total == 0 ? kNan : static_cast<double>(hits) / static_cast<double>(total), interval};
}

Rate over_heaps(const PerceptionRow& row, ClusterCount LookScore::*counter, const char* name) {
  std::vector<ClusterCount> piles;
  ClusterCount sum;
  for (const LookScore& look : row.looks) {
    piles.push_back(look.*counter);
    sum.hits += piles.back().hits;
    sum.total += piles.back().total;
  }
  return rate_of(static_cast<std::size_t>(sum.hits), static_cast<std::size_t>(sum.total),
                 cluster_bootstrap(piles, Seed{}.child("bench perception").child(name)));
}

Rate first_right(const PerceptionRow& row, bool clear_only) {
  std::size_t hits = 0, total = 0;
  for (const LookScore& look : row.looks) {
    if (!look.top1 || (clear_only && !look.top1_in_clear_view)) continue;
    ++total;
    hits += *look.top1 ? 1 : 0;
  }
  return rate_of(hits, total, wilson_interval(hits, total));
}

Rate early_right(const PerceptionRow& row) {
  std::size_t hits = 0, total = 0;
  for (const LookScore& look : row.looks) {
    if (!look.first_right) continue;
    ++total;
    hits += *look.first_right ? 1 : 0;
  }
  return rate_of(hits, total, wilson_interval(hits, total));
}

double of_right(const PerceptionRow& row, double q, double (*value)(const RightEstimate&)) {
  std::vector<double> values;
  for (const LookScore& look : row.looks)
    for (const RightEstimate& right : look.right) values.push_back(value(right));
  return quantile(values, q);
}

double of_times(const PerceptionRow& row, double q, double LookTimes::*which) {
  std::vector<double> values;
  for (const LookTimes& times : row.times) values.push_back(times.*which);
  return quantile(values, q);
}

void add_errors(const PerceptionRow& row, RowFigures& out) {
  const auto translation = [](const RightEstimate& e) { return e.translation; };
  const auto rotation = [](const RightEstimate& e) { return e.rotation; };
  out.translation_median = of_right(row, 0.5, translation);
  out.translation_p95 = of_right(row, 0.95, translation);
  out.rotation_median = of_right(row, 0.5, rotation);
  out.rotation_p95 = of_right(row, 0.95, rotation);
  out.lateral_median = of_right(row, 0.5, [](const RightEstimate& e) { return e.lateral; });
  out.abs_z_median = of_right(row, 0.5, [](const RightEstimate& e) { return std::abs(e.z); });
  out.z_bias = of_right(row, 0.5, [](const RightEstimate& e) { return e.z; });
}

}  // namespace

RowFigures figures_of(const PerceptionRow& row) {
  RowFigures out;
  out.recall = over_heaps(row, &LookScore::recall, "recall");
  out.recall_partly = over_heaps(row, &LookScore::recall_partly, "recall_partly");
  out.recall_tight = over_heaps(row, &LookScore::recall_tight, "recall_tight");
  out.precision = over_heaps(row, &LookScore::precision, "precision");
  out.recall_clear = over_heaps(row, &LookScore::recall_clear, "recall_clear");
  out.precision_clear = over_heaps(row, &LookScore::precision_clear, "precision_clear");
  out.precision_sure = over_heaps(row, &LookScore::precision_sure, "precision_sure");
  out.top1 = first_right(row, false);
  out.top1_clear = first_right(row, true);
  out.first = early_right(row);
  add_errors(row, out);
  for (double LookTimes::*which : {&LookTimes::total, &LookTimes::cpu, &LookTimes::first, &LookTimes::preprocess,
                                   &LookTimes::voting, &LookTimes::verification, &LookTimes::icp})
    out.median.*which = of_times(row, 0.5, which);
  if (!row.has_first) out.median.first = kNan;
  out.total_p95 = of_times(row, 0.95, &LookTimes::total);
  return out;
}

double time_ratio(const PerceptionRow& peer, const PerceptionRow& row) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < peer.looks.size(); ++i)
    for (std::size_t k = 0; k < row.looks.size(); ++k)
      if (row.looks[k].seed == peer.looks[i].seed) ratios.push_back(peer.times[i].total / row.times[k].total);
  return quantile(ratios, 0.5);
}

}  // namespace binpick

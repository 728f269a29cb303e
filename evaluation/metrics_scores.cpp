#include "evaluation/metrics_scores.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/check.hpp"

namespace binpick {
namespace {

bool looked_at(const ImageErrors::Estimate& estimate, Task task) {
  return task == Task::kLocalisation ? estimate.asked : estimate.kept;
}

std::vector<std::size_t> by_score(const std::vector<ImageErrors::Estimate>& estimates) {
  std::vector<std::size_t> order(estimates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return estimates[a].score > estimates[b].score; });
  return order;
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void sort_by_score(std::vector<Judged>& judged) {
  std::stable_sort(judged.begin(), judged.end(), [](const Judged& a, const Judged& b) { return a.score > b.score; });
}

}  // namespace

ErrorTable::ErrorTable(std::size_t estimates, std::size_t instances)
    : instances_(instances), values_(estimates * instances, std::numeric_limits<double>::infinity()) {}

std::vector<double> bop_thresholds() { return ten_steps_of(0.05); }

std::vector<double> ten_steps_of(double first) {
  std::vector<double> steps;
  for (int k = 0; k < 10; ++k) steps.push_back(first + k * first);
  return steps;
}

Matches match_greedily(const ImageErrors& image, const ErrorTable& errors, double threshold, Task task) {
  Matches matches(image.estimates.size());
  std::vector<bool> taken(image.instances.size(), false);
  for (const std::size_t e : by_score(image.estimates)) {
    if (!looked_at(image.estimates[e], task)) continue;
    double least = threshold;
    for (std::size_t i = 0; i < image.instances.size(); ++i) {
      const ImageErrors::Instance& instance = image.instances[i];
      if (taken[i] || instance.object != image.estimates[e].object) continue;
      if (task == Task::kLocalisation && !instance.target) continue;
      if (!(errors.at(e, i) < least)) continue;
      least = errors.at(e, i);
      matches[e] = i;
    }
    if (matches[e]) taken[*matches[e]] = true;
  }
  return matches;
}

double localisation_recall(std::span<const ImageErrors> images, const TableOf& table, double threshold) {
  std::size_t found = 0, targets = 0;
  for (const ImageErrors& image : images) {
    for (const auto& match : match_greedily(image, table(image), threshold, Task::kLocalisation))
      found += match.has_value() ? 1 : 0;
    for (const ImageErrors::Instance& instance : image.instances) targets += instance.target ? 1 : 0;
  }
  return targets == 0 ? 0 : static_cast<double>(found) / static_cast<double>(targets);
}

double average_recall(std::span<const ImageErrors> images, const TableOf& table,
                      const std::vector<double>& thresholds) {
  std::vector<double> recalls;
  for (const double threshold : thresholds) recalls.push_back(localisation_recall(images, table, threshold));
  return mean(recalls);
}

double interpolated_precision(const std::vector<Judged>& judged, std::size_t targets) {
  BP_CHECK(targets > 0);
  struct Point {
    double recall, precision;
  };
  std::vector<Point> curve;
  std::size_t right = 0;
  for (std::size_t k = 0; k < judged.size(); ++k) {
    right += judged[k].right ? 1 : 0;
    curve.push_back({static_cast<double>(right) / static_cast<double>(targets),
                     static_cast<double>(right) / static_cast<double>(k + 1)});
  }
  for (std::size_t k = curve.size(); k-- > 1;)
    curve[k - 1].precision = std::max(curve[k - 1].precision, curve[k].precision);
  double sum = 0;
  std::size_t k = 0;
  for (int step = 0; step <= 100; ++step) {
    while (k < curve.size() && curve[k].recall < step * 0.01) ++k;
    if (k < curve.size()) sum += curve[k].precision;
  }
  return sum / 101;
}

std::map<int, Detections> detections_by_object(std::span<const ImageErrors> images, const TableOf& table,
                                               double threshold) {
  std::map<int, Detections> found;
  for (const ImageErrors& image : images) {
    for (const ImageErrors::Instance& instance : image.instances)
      found[instance.object].targets += instance.visible >= kLeastVisible ? 1 : 0;
    const Matches matches = match_greedily(image, table(image), threshold, Task::kDetection);
    for (const std::size_t e : by_score(image.estimates)) {
      const ImageErrors::Estimate& estimate = image.estimates[e];
      if (!estimate.kept) continue;
      if (matches[e] && image.instances[*matches[e]].visible < kLeastVisible) continue;
      found[estimate.object].judged.push_back({estimate.score, matches[e].has_value()});
    }
  }
  for (auto& [object, one] : found) sort_by_score(one.judged);
  return found;
}

Detections detections(std::span<const ImageErrors> images, const TableOf& table, double threshold) {
  Detections all;
  for (const auto& [object, one] : detections_by_object(images, table, threshold)) {
    all.judged.insert(all.judged.end(), one.judged.begin(), one.judged.end());
    all.targets += one.targets;
  }
  sort_by_score(all.judged);
  return all;
}

std::map<int, std::vector<double>> detection_precision(std::span<const ImageErrors> images, const TableOf& table,
                                                       const std::vector<double>& thresholds) {
  std::map<int, std::vector<double>> precision;
  for (const double threshold : thresholds)
    for (const auto& [object, one] : detections_by_object(images, table, threshold))
      if (one.targets > 0) precision[object].push_back(interpolated_precision(one.judged, one.targets));
  return precision;
}

double mean_average_precision(const std::map<int, std::vector<double>>& by_object) {
  std::vector<double> means;
  for (const auto& [object, precisions] : by_object) means.push_back(mean(precisions));
  return mean(means);
}

}  // namespace binpick

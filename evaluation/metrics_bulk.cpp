#include "evaluation/metrics_bulk.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>

namespace binpick {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::size_t> that_count(const ImageErrors& scene, double threshold, std::optional<std::size_t> best) {
  std::vector<std::size_t> counting;
  for (std::size_t e = 0; e < scene.estimates.size(); ++e)
    if (scene.estimates[e].kept && scene.estimates[e].score >= threshold) counting.push_back(e);
  std::stable_sort(counting.begin(), counting.end(),
                   [&](std::size_t a, std::size_t b) { return scene.estimates[a].score > scene.estimates[b].score; });
  if (best && counting.size() > *best) counting.resize(*best);
  return counting;
}

std::optional<std::size_t> nearest_instance(const ImageErrors& scene, std::size_t estimate) {
  std::optional<std::size_t> nearest;
  double least = 1;  // the limit
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (!(scene.surface.at(estimate, i) < least)) continue;
    least = scene.surface.at(estimate, i);
    nearest = i;
  }
  return nearest;
}

std::optional<std::size_t> nearest_estimate(const ImageErrors& scene, const std::vector<std::size_t>& counting,
                                            std::size_t instance) {
  std::optional<std::size_t> nearest;
  double least = kInfinity;
  for (const std::size_t e : counting) {  // the better score first: it wins where two are equally near
    if (!(scene.surface.at(e, instance) < least)) continue;
    least = scene.surface.at(e, instance);
    nearest = e;
  }
  return nearest;
}

std::vector<double> thresholds_of(std::span<const ImageErrors> scenes) {
  std::set<double, std::greater<>> scores = {kInfinity};
  for (const ImageErrors& scene : scenes)
    for (const ImageErrors::Estimate& estimate : scene.estimates)
      if (estimate.kept) scores.insert(estimate.score);
  return {scores.begin(), scores.end()};
}

double area_under(const std::vector<BulkPoint>& curve) {
  double area = 0, recall = 0;
  for (const BulkPoint& point : curve) {
    area += point.precision * (point.recall - recall);
    recall = point.recall;
  }
  return area;
}

std::vector<BulkPoint> curve_of(const ImageErrors& scene, const std::vector<double>& thresholds,
                                std::optional<std::size_t> best) {
  std::vector<BulkPoint> curve;
  for (const double threshold : thresholds) {
    const bool changes = curve.empty() || std::any_of(scene.estimates.begin(), scene.estimates.end(),
                                                      [&](const auto& e) { return e.score == threshold; });
    curve.push_back(changes ? bulk_point(scene, threshold, best) : curve.back());
    curve.back().threshold = threshold;
  }
  return curve;
}

}  // namespace

BulkPoint bulk_point(const ImageErrors& scene, double threshold, std::optional<std::size_t> best) {
  const std::vector<std::size_t> counting = that_count(scene, threshold, best);
  std::size_t right = 0, wrong = 0, wanted = 0;
  for (const ImageErrors::Instance& instance : scene.instances) wanted += instance.visible >= kToBeFound ? 1 : 0;
  if (best) wanted = std::min(wanted, *best);
  for (const std::size_t e : counting) {
    const auto instance = nearest_instance(scene, e);
    if (!instance || nearest_estimate(scene, counting, *instance) != e) {
      ++wrong;
    } else if (scene.instances[*instance].visible >= kToBeFound) {
      ++right;
    }
  }
  BulkPoint point;
  point.threshold = threshold;
  if (right + wrong > 0) point.precision = static_cast<double>(right) / static_cast<double>(right + wrong);
  point.recall = wanted == 0 ? 1 : static_cast<double>(right) / static_cast<double>(wanted);
  return point;
}

BulkScore bulk_score(std::span<const ImageErrors> scenes, std::optional<std::size_t> best) {
  BulkScore score;
  if (scenes.empty()) return score;
  for (const double threshold : thresholds_of(scenes)) score.curve.push_back({threshold, 0, 0});
  const std::vector<double> thresholds = thresholds_of(scenes);
  const double share = 1.0 / static_cast<double>(scenes.size());
  for (const ImageErrors& scene : scenes) {
    const std::vector<BulkPoint> curve = curve_of(scene, thresholds, best);
    score.mean_ap += share * area_under(curve);
    for (std::size_t k = 0; k < curve.size(); ++k) {
      score.curve[k].precision += share * curve[k].precision;
      score.curve[k].recall += share * curve[k].recall;
    }
  }
  score.ap = area_under(score.curve);
  for (const BulkPoint& p : score.curve) {
    if (p.precision + p.recall > 0)
      score.best_f1 = std::max(score.best_f1, 2 * p.precision * p.recall / (p.precision + p.recall));
    if (p.precision >= 0.99 - 1e-12) score.recall_at_99 = std::max(score.recall_at_99, p.recall);
  }
  return score;
}

}  // namespace binpick

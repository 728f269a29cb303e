#include "evaluation/metrics_curves.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace binpick {

std::vector<CurvePoint> precision_recall(const std::vector<Judged>& judged, std::size_t targets) {
  std::vector<CurvePoint> curve;
  std::size_t right = 0;
  for (std::size_t k = 0; k < judged.size(); ++k) {
    right += judged[k].right ? 1 : 0;
    if (k + 1 < judged.size() && judged[k + 1].score == judged[k].score) continue;
    const double precision = static_cast<double>(right) / static_cast<double>(k + 1);
    curve.push_back({judged[k].score, precision, targets == 0 ? 0 : static_cast<double>(right) / double(targets)});
  }
  return curve;
}

Calibration score_calibration(const std::vector<Judged>& judged, int bins) {
  BP_CHECK(bins > 0, bins);
  std::vector<Calibration::Bin> all(static_cast<std::size_t>(bins));
  for (std::size_t k = 0; k < all.size(); ++k) all[k].low = double(k) / bins, all[k].high = double(k + 1) / bins;
  Calibration calibration;
  std::size_t count = 0;
  for (const Judged& one : judged) {
    if (!(one.score >= 0 && one.score <= 1)) {
      ++calibration.outside;
      continue;
    }
    Calibration::Bin& bin = all[std::min(static_cast<std::size_t>(one.score * bins), all.size() - 1)];
    ++count, ++bin.count;
    bin.right += one.right ? 1 : 0;
    bin.mean_score += one.score;
    calibration.brier += std::pow(one.score - (one.right ? 1 : 0), 2);
  }
  for (Calibration::Bin& bin : all) {
    if (bin.count == 0) continue;
    calibration.expected_error += std::abs(double(bin.right) - bin.mean_score) / double(count);
    bin.mean_score /= double(bin.count);
    calibration.bins.push_back(bin);
  }
  if (count > 0) calibration.brier /= double(count);
  return calibration;
}

std::vector<double> visibility_edges() { return {0, 0.1, 0.3, 0.5, 0.7, 0.9, 1}; }

std::vector<VisibilityBin> recall_by_visibility(std::span<const ImageErrors> images, const TableOf& table,
                                                double threshold, const std::vector<double>& edges) {
  BP_CHECK(edges.size() >= 2);
  std::vector<VisibilityBin> bins;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) bins.push_back({edges[k], edges[k + 1], 0, 0});
  for (const ImageErrors& image : images) {
    std::vector<bool> found(image.instances.size(), false);
    for (const auto& match : match_greedily(image, table(image), threshold, Task::kDetection))
      if (match) found[*match] = true;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double visible = image.instances[i].visible;
      for (VisibilityBin& bin : bins) {
        if (visible < bin.low || (visible >= bin.high && !(&bin == &bins.back() && visible == bin.high))) continue;
        ++bin.instances;
        bin.found += found[i] ? 1 : 0;
        break;
      }
    }
  }
  return bins;
}

}  // namespace binpick

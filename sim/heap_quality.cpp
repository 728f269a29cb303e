#include "sim/heap_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/check.hpp"

namespace binpick {
namespace {

constexpr double kToSigma = 1.4826;  // of the median absolute deviation of Gaussian numbers
constexpr int kFringe = 6;           // px of fattened foreground between the outline and the shadow

double median_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double robust_sigma(std::vector<double> values) {
  const double centre = median_of(values);
  for (double& value : values) value = std::abs(value - centre);
  return kToSigma * median_of(std::move(values));
}

// Lost pixels from the outline at column u leftwards, past the fringe.
int lost_run(const Image<float>& depth, int u, int v) {
  int column = u - 1;
  for (int k = 0; k < kFringe && column >= 0 && !std::isnan(depth(column, v)); ++k) --column;
  int run = 0;
  for (; column >= 0 && std::isnan(depth(column, v)); --column) ++run;
  return run;
}

}  // namespace

HeapQuality heap_quality(const Image<float>& depth, const ExactFrame& exact, bool parts) {
  BP_CHECK(depth.size() == exact.ids.size());
  std::vector<double> errors, inverse_errors;
  HeapQuality quality;
  std::size_t gross = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const std::int32_t id = exact.ids[i];
    if (id == kIdNothing || (id < kIdBin) != parts) continue;
    ++quality.pixels;
    if (std::isnan(depth[i])) continue;
    const double z = depth[i], truth = exact.depth[i];
    errors.push_back(z - truth);
    inverse_errors.push_back(1 / z - 1 / truth);
    gross += std::abs(z - truth) > kGross ? 1 : 0;
  }
  quality.fill = static_cast<double>(errors.size()) / static_cast<double>(quality.pixels);
  quality.gross = static_cast<double>(gross) / static_cast<double>(errors.size());
  quality.bias = median_of(errors);
  quality.sigma = robust_sigma(std::move(errors));
  quality.inverse_depth_noise = robust_sigma(std::move(inverse_errors));
  return quality;
}

double shadow_width(const Image<float>& depth, const ExactFrame& exact) {
  std::vector<double> runs;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 1; u < depth.width(); ++u) {
      const double behind = exact.depth(u - 1, v), before = exact.depth(u, v);
      if (behind - before >= kShadowStep) runs.push_back(lost_run(depth, u, v));
    }
  return median_of(std::move(runs));
}

}  // namespace binpick

#include "perception/floor_offset.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "perception/scene_crop.hpp"

namespace binpick {
namespace {

constexpr int kBins = 121;  // over +- the largest offset
constexpr std::size_t kFewestPixels = 300;
constexpr double kMostPixels = 4e4;    // of the image: neighbours share their noise anyway
constexpr double kFewestShare = 0.02;  // of the bin's pixels
constexpr double kModeShare = 0.4;     // of the highest mode: a deeper mode this high is the floor
constexpr double kSmoothing = 0.001;   // m, of the histogram
constexpr double kMargin = 0.01;       // m off the walls, where they mix into the floor

/// 1/z - 1/z_floor of the pixels that see the floor's place, thinned to about kMostPixels.
std::vector<float> inverse_depth_differences(const Scene& scene, std::size_t& looked_at) {
  const auto f = [](double x) { return static_cast<float>(x); };
  const BinRays rays = bin_rays(scene.camera, scene.X_CB);
  const Eigen::Vector3d half = scene.bin->inner_size / 2;
  const BinBox box{f(half.x() - kMargin), f(half.y() - kMargin)};
  const int width = scene.depth.width(), height = scene.depth.height();
  const int stride = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(scene.depth.size()) / kMostPixels)));
  std::vector<float> out, row(static_cast<std::size_t>(width));
  int rays_on_floor = 0;
  for (int v = 0; v < height; v += stride) {
    const int count = floor_differences({&scene.depth(0, v), v, width}, stride, rays, box, row.data(), rays_on_floor);
    for (int k = 0; k < count; ++k)
      if (!std::isnan(row[k])) out.push_back(row[k]);
  }
  looked_at = static_cast<std::size_t>(rays_on_floor);
  return out;
}

/// The centre of the deepest (smallest) bin that is a clear local mode.
int deepest_mode(const std::vector<double>& histogram) {
  const double most = *std::max_element(histogram.begin(), histogram.end());
  for (int b = 0; b < kBins; ++b) {
    const double left = b > 0 ? histogram[b - 1] : 0, right = b + 1 < kBins ? histogram[b + 1] : 0;
    if (histogram[b] >= kModeShare * most && histogram[b] >= left && histogram[b] >= right) return b;
  }
  return kBins / 2;
}

/// Standard deviation of what lies within `window` of a value, from the median distance (robust).
double spread_about(const std::vector<float>& values, double center, double window) {
  std::vector<double> off;
  for (const float v : values)
    if (std::abs(v - center) < window) off.push_back(std::abs(v - center));
  if (off.empty()) return 0;
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return 1.4826 * *middle;
}

}  // namespace

double floor_offset(const Scene& scene, double largest) {
  std::size_t looked_at = 0;
  const std::vector<float> differences = inverse_depth_differences(scene, looked_at);
  const double z = scene.X_CB.translation().z(), range = largest / (z * z), width = 2 * range / kBins;
  const double sigma = std::max(scene.noise.sigma(z) / (z * z), width);
  std::vector<double> counts(kBins, 0.0), smooth(kBins, 0.0);
  std::size_t inside = 0;
  for (const float d : differences)
    if (std::abs(d) < range) {
      counts[std::min(kBins - 1, static_cast<int>((d + range) / width))] += 1;
      ++inside;
    }
  if (inside < kFewestPixels || static_cast<double>(inside) < kFewestShare * static_cast<double>(looked_at)) return 0;
  // Wide enough to bridge the gaps of a histogram of correlated noise, also where no noise is stated (a bare cloud).
  const int half = std::max(1, static_cast<int>(std::max(sigma, kSmoothing / (z * z)) / width));
  for (int b = 0; b < kBins; ++b)
    for (int k = std::max(0, b - half); k <= std::min(kBins - 1, b + half); ++k)
      smooth[b] += counts[k] * (half + 1 - std::abs(k - b));
  double offset = (deepest_mode(smooth) + 0.5) * width - range;
  for (int round = 0; round < 8; ++round) {
    const double spread = 2 * std::max(sigma, spread_about(differences, offset, 3 * kSmoothing / (z * z)));
    double sum = 0;
    std::size_t n = 0;
    for (const float d : differences)
      if (std::abs(d - offset) < spread) sum += d, ++n;
    if (n < kFewestPixels) return 0;
    const double mean = sum / static_cast<double>(n);
    if (std::abs(mean - offset) < 1e-7 * width) break;
    offset = mean;
  }
  return std::abs(offset) < range ? offset : 0;
}

}  // namespace binpick

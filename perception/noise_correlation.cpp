#include "perception/noise_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace binpick {
namespace {

constexpr int kNext = 1, kShort = 3, kLong = 9;  // px; the first is blind to windows where the depth step is coarse,
                                                 // the second to windows smaller than itself
constexpr int kEvery = 2;                        // rows looked at
constexpr std::size_t kFewest = 60;              // differences
constexpr double kSmall = 6;                     // px, values up to which the first lag is believed
constexpr double kUnmeasured = 40;               // px, of a camera whose foreground grows: it matches windows
constexpr float kFlat = 0.9f;                    // cosine between the normals at the ends of the long lag
constexpr double kLargest = 6;                   // px, s

bool flat(const Scene& scene, int u, int v) {
  const Eigen::Vector3f &left = scene.normals(u - kLong, v), &right = scene.normals(u + kLong, v);
  return left.dot(right) > kFlat && left.dot(scene.normals(u, v)) > kFlat;
}

/// Median absolute second difference of 1/z along rows: linear on planes, robust against the rest.
double median_difference(const Scene& scene, int lag) {
  std::vector<float> all;
  for (int v = 0; v < scene.depth.height(); v += kEvery)
    for (int u = kLong; u + kLong < scene.depth.width(); ++u) {
      if (!flat(scene, u, v)) continue;
      const float d = 1 / scene.depth(u - lag, v) - 2 / scene.depth(u, v) + 1 / scene.depth(u + lag, v);
      if (std::isfinite(d)) all.push_back(std::abs(d));
    }
  if (all.size() < kFewest) return 0;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle;
}

double expected(int lag, double s) {
  const auto r = [s](int k) { return std::exp(-k * k / (4 * s * s)); };
  return 6 - 8 * r(lag) + 2 * r(2 * lag);
}

}  // namespace

double pixels_per_noise_value(const Scene& scene) {
  const double unmeasured = scene.noise.fattening_px > 0 ? kUnmeasured : 1;
  const double far = median_difference(scene, kLong);
  if (!(far > 0)) return unmeasured;
  const auto from_lag = [&](int lag) {
    const double quotient = median_difference(scene, lag) / far;
    double s = 0.25;  // the ratio falls with s
    while (s < kLargest && expected(lag, s) / expected(kLong, s) > quotient * quotient) s += 0.05;
    return std::max(1.0, 4 * std::numbers::pi * s * s);
  };
  const double next = from_lag(kNext);
  return next < kSmall ? next : std::max(next, from_lag(kShort));
}

}  // namespace binpick

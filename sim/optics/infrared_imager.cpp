#include "sim/optics/infrared_imager.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.hpp"

namespace binpick {
namespace {

constexpr int kBisections = 40;
constexpr std::size_t kMeterStride = 7;  // of the pixels, one in so many is metered

// Gamma(k, 1/k) from a normal z (Wilson and Hilferty 1931): the cube root of a Gamma variable is nearly normal. At
// k = 398 its mean and variance are right to 1e-5.
double gamma_factor(double shape, double z) {
  const double c = 1 / (9 * shape);
  const double root = std::max(1 - c + z * std::sqrt(c), 0.0);
  return root * root * root;
}

double metered_mean(const Image<float>& radiance, double gain) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < radiance.size(); i += kMeterStride, ++count)
    sum += std::min(gain * static_cast<double>(radiance[i]), 255.0);
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace

void blur(Image<float>& image, double w) {
  const int width = image.width(), height = image.height();
  const float side = static_cast<float>(w), centre = 1 - 2 * side;
  std::vector<float> line(static_cast<std::size_t>(width)), above(line.size()), here(line.size());
  for (int v = 0; v < height; ++v) {
    float* row = &image(0, v);
    std::copy(row, row + width, line.begin());
    for (int u = 0; u < width; ++u)
      row[u] = centre * line[static_cast<std::size_t>(u)] +
               side * (line[static_cast<std::size_t>(std::max(u - 1, 0))] +
                       line[static_cast<std::size_t>(std::min(u + 1, width - 1))]);
  }
  for (int v = 0; v < height; ++v) {
    float* row = &image(0, v);
    const float* below = &image(0, std::min(v + 1, height - 1));
    std::copy(row, row + width, here.begin());
    if (v == 0) above = here;
    for (int u = 0; u < width; ++u) {
      const auto i = static_cast<std::size_t>(u);
      row[u] = centre * here[i] + side * (above[i] + below[u]);
    }
    above.swap(here);
  }
}

double exposure_for_mean(const Image<float>& radiance, double mean_grey, double max_gain) {
  if (metered_mean(radiance, max_gain) <= mean_grey) return max_gain;
  double low = 0, high = max_gain;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (metered_mean(radiance, middle) < mean_grey ? low : high) = middle;
  }
  return high;
}

Image<std::uint8_t> expose(const Image<float>& radiance, double gain, const InfraredNoise& noise, const Rng& fixed,
                           const Rng& changing, int threads) {
  Image<std::uint8_t> grey(radiance.width(), radiance.height());
  const double share = std::sqrt(noise.fixed_share), rest = std::sqrt(1 - noise.fixed_share);
  parallel_for(static_cast<std::size_t>(radiance.height()), threads, [&](std::size_t v) {
    for (int u = 0; u < radiance.width(); ++u) {
      const std::size_t i = v * static_cast<std::size_t>(radiance.width()) + static_cast<std::size_t>(u);
      Rng now = changing.at(i);
      double light = gain * radiance[i];
      if (noise.speckle_shape > 0 && light > 0) {
        double z = rest * now.normal();
        if (share > 0) z += share * fixed.at(i).normal();
        light *= gamma_factor(noise.speckle_shape, z);
      }
      light += noise.thermal * now.normal();
      grey[i] = static_cast<std::uint8_t>(std::lround(std::clamp(light, 0.0, 255.0)));
    }
  });
  return grey;
}

}  // namespace binpick

#include "sim/noise/correlated_field.hpp"

#include <cmath>
#include <vector>

namespace binpick {
namespace {

// Half a Gaussian, cut at 3.5 standard deviations: weights of offsets 0, 1, ..; the squares of the whole kernel sum to
// 1, so that filtered white noise keeps variance 1.
std::vector<float> half_kernel(double length) {
  if (!(length > 0)) return {1.0f};
  const int radius = static_cast<int>(std::ceil(3.5 * length));
  std::vector<double> weights;
  double squares = 0;
  for (int k = 0; k <= radius; ++k) {
    weights.push_back(std::exp(-0.5 * k * k / (length * length)));
    squares += (k == 0 ? 1 : 2) * weights.back() * weights.back();
  }
  std::vector<float> kernel;
  for (const double w : weights) kernel.push_back(static_cast<float>(w / std::sqrt(squares)));
  return kernel;
}

// Standard normal numbers by index; each item of the stream gives two of them.
void add_white(std::vector<float>& noise, double scale, const Rng& rng) {
  if (!(scale > 0)) return;
  for (std::size_t i = 0; i < noise.size(); i += 2) {
    Rng draw = rng.at(i / 2);
    noise[i] += static_cast<float>(scale * draw.normal());
    if (i + 1 < noise.size()) noise[i + 1] += static_cast<float>(scale * draw.normal());
  }
}

}  // namespace

Image<float> correlated_field(int width, int height, const CorrelatedField& field, const Rng& fixed,
                              const Rng& changing) {
  const std::vector<float> kernel = half_kernel(field.length);
  const int radius = static_cast<int>(kernel.size()) - 1;
  const int wide = width + 2 * radius, high = height + 2 * radius;
  std::vector<float> white(static_cast<std::size_t>(wide) * high, 0.0f);
  add_white(white, std::sqrt(field.fixed_share), fixed);
  add_white(white, std::sqrt(1 - field.fixed_share), changing);

  Image<float> out(width, height, 0.0f);
  std::vector<float> column_sum(wide);
  for (int v = 0; v < height; ++v) {
    const float* middle = white.data() + static_cast<std::size_t>(v + radius) * wide;
    for (int x = 0; x < wide; ++x) column_sum[x] = kernel[0] * middle[x];
    for (int k = 1; k <= radius; ++k) {
      const float *above = middle - static_cast<std::ptrdiff_t>(k) * wide,
                  *below = middle + static_cast<std::ptrdiff_t>(k) * wide;
      for (int x = 0; x < wide; ++x) column_sum[x] += kernel[k] * (above[x] + below[x]);
    }
    float* row = &out(0, v);
    const float* centre = column_sum.data() + radius;
    for (int u = 0; u < width; ++u) row[u] = kernel[0] * centre[u];
    for (int k = 1; k <= radius; ++k)
      for (int u = 0; u < width; ++u) row[u] += kernel[k] * (centre[u - k] + centre[u + k]);
  }
  return out;
}

}  // namespace binpick

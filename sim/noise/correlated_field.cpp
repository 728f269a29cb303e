#include "sim/noise/correlated_field.hpp"

#include <cmath>
#include <vector>

#include "core/random_field.hpp"
#include "sim/noise/row_kernels.hpp"
#include "sim/noise/rows.hpp"

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

}  // namespace

Image<float> correlated_field(int width, int height, const CorrelatedField& field, const Rng& fixed,
                              const Rng& changing, int threads) {
  const std::vector<float> kernel = half_kernel(field.length);
  const int radius = static_cast<int>(kernel.size()) - 1;
  const int wide = width + 2 * radius, high = height + 2 * radius;
  const auto fixed_scale = static_cast<float>(std::sqrt(field.fixed_share));
  const auto changing_scale = static_cast<float>(std::sqrt(1 - field.fixed_share));
  Image<float> white(wide, high);
  for_rows(high, threads, [&](int first, int end) {
    std::vector<float> draws(static_cast<std::size_t>(wide));
    for (int v = first; v < end; ++v) {
      fill_normals(fixed, static_cast<std::uint64_t>(v), draws);
      scale_row(&white(0, v), draws.data(), fixed_scale, wide);
      fill_normals(changing, static_cast<std::uint64_t>(v), draws);
      add_row(&white(0, v), draws.data(), changing_scale, wide);
    }
  });
  Image<float> out(width, height);
  for_rows(height, threads, [&](int first, int end) {
    std::vector<float> sum(static_cast<std::size_t>(wide));  // of a column's neighbourhood
    for (int v = first; v < end; ++v) {
      scale_row(sum.data(), &white(0, v + radius), kernel[0], wide);
      for (int k = 1; k <= radius; ++k)
        add_pair(sum.data(), &white(0, v + radius - k), &white(0, v + radius + k), kernel[k], wide);
      scale_row(&out(0, v), sum.data() + radius, kernel[0], width);
      for (int k = 1; k <= radius; ++k)
        add_pair(&out(0, v), sum.data() + radius - k, sum.data() + radius + k, kernel[k], width);
    }
  });
  return out;
}

}  // namespace binpick

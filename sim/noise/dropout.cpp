#include "sim/noise/dropout.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "core/random_field.hpp"
#include "sim/noise/rows.hpp"

namespace binpick {
namespace {

// Six widths before the critical angle a pixel is lost with a probability below this.
constexpr double kSafeWidths = 6;
constexpr float kSafeProbability = 0.0025f;

void drop(DisparityImage& image, std::size_t i) {
  image.disparity[i] = std::numeric_limits<float>::quiet_NaN();
  image.source[i] = -1;
}

bool is_lost(const StereoView& view, const Dropout& dropout, std::size_t source, float draw) {
  const double cosine = view.cos_incidence(source);
  const double z = view.exact.depth[source];
  double light = view.exact.materials[view.exact.ids[source]].albedo * cosine / (z * z);
  if (dropout.lobe > 0) light += dropout.lobe * std::pow(cosine, dropout.lobe_exponent);
  if (light < dropout.return_low || light > dropout.return_high) return true;
  const double beyond = (std::acos(cosine) - dropout.grazing_angle) / dropout.grazing_width;
  return draw < 1 / (1 + std::exp(-beyond));
}

}  // namespace

void drop_returns(const StereoView& view, const Dropout& dropout, const Rng& rng, DisparityImage& image) {
  const double safe_angle = dropout.grazing_angle - kSafeWidths * dropout.grazing_width;
  const double safe_cosine = safe_angle > 0 ? std::cos(safe_angle) : 2;
  const int width = view.camera.width;
  for_rows(view.camera.height, view.threads, [&](int first, int end) {
    std::vector<float> draws(static_cast<std::size_t>(width));
    for (int v = first; v < end; ++v) {
      fill_uniforms(rng, static_cast<std::uint64_t>(v), draws);
      for (int u = 0; u < width; ++u) {
        const std::size_t i = view.index(u, v);
        if (image.source[i] < 0) continue;
        const auto source = static_cast<std::size_t>(image.source[i]);
        const float draw = draws[static_cast<std::size_t>(u)];
        const double z = view.exact.depth[source], cosine = view.cos_incidence(source);
        // Most pixels are lit well and far from grazing, and need no acos.
        if (dropout.lobe == 0 && cosine > safe_cosine && draw > kSafeProbability) {
          const double light = view.exact.materials[view.exact.ids[source]].albedo * cosine;
          if (light >= dropout.return_low * z * z && light <= dropout.return_high * z * z) continue;
        }
        if (is_lost(view, dropout, source, draw)) drop(image, i);
      }
    }
  });
}

void drop_speckles(double probability, const Rng& rng, int threads, DisparityImage& image) {
  if (!(probability > 0)) return;
  const int width = image.source.width();
  for_rows(image.source.height(), threads, [&](int first, int end) {
    std::vector<float> draws(static_cast<std::size_t>(width));
    for (int v = first; v < end; ++v) {
      fill_uniforms(rng, static_cast<std::uint64_t>(v), draws);
      const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(width);
      for (std::size_t u = 0; u < draws.size(); ++u)
        if (draws[u] < probability && image.source[row + u] >= 0) drop(image, row + u);
    }
  });
}

}  // namespace binpick

#include "sim/noise/mixed_pixels.hpp"

#include <cmath>

namespace binpick {
namespace {

// The farthest match among the four neighbours that lies behind this pixel's surface; NaN when there is none.
float behind_outline(const StereoView& view, const DisparityImage& image, int u, int v) {
  constexpr int kNeighbours[][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  const float own = image.disparity(u, v);
  const auto source = static_cast<std::size_t>(image.source(u, v));
  float farthest = std::nanf("");
  for (const auto& [du, dv] : kNeighbours) {
    if (!image.source.contains(u + du, v + dv) || image.source(u + du, v + dv) < 0) continue;
    const float other = image.disparity(u + du, v + dv);
    if (!(other + kDisparityStep < own) || other >= farthest) continue;
    // Noise-free planes decide what is a step; the mixture uses the noisy values.
    const auto other_source = static_cast<std::size_t>(image.source(u + du, v + dv));
    const double here = view.disparity_at(source, u + du, v + dv);
    if (here > view.disparity_at(other_source, u + du, v + dv) + kDisparityStep) farthest = other;
  }
  return farthest;
}

}  // namespace

void mix_outlines(const StereoView& view, double probability, const Rng& rng, DisparityImage& image) {
  if (!(probability > 0)) return;
  const DisparityImage before = image;
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u) {
      if (before.source(u, v) < 0) continue;
      const float farther = behind_outline(view, before, u, v);
      if (std::isnan(farther)) continue;
      Rng draw = rng.at(view.index(u, v));
      if (draw.uniform() >= probability) continue;
      const auto share = static_cast<float>(draw.uniform());
      image.disparity(u, v) = share * before.disparity(u, v) + (1 - share) * farther;
    }
}

}  // namespace binpick

#include "sim/noise/mixed_pixels.hpp"

#include <cmath>

#include "sim/noise/rows.hpp"

namespace binpick {
namespace {

// The farthest match among the four neighbours that lies behind this pixel's surface; NaN when there is none.
float behind_outline(const StereoView& view, const Image<float>& disparity, const Image<std::int32_t>& source_of, int u,
                     int v) {
  constexpr int kNeighbours[][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  const float own = disparity(u, v);
  const auto source = static_cast<std::size_t>(source_of(u, v));
  float farthest = std::nanf("");
  for (const auto& [du, dv] : kNeighbours) {
    if (!source_of.contains(u + du, v + dv) || source_of(u + du, v + dv) < 0) continue;
    const float other = disparity(u + du, v + dv);
    if (!(other + kDisparityStep < own) || other >= farthest) continue;
    // Noise-free planes decide what is a step; the mixture uses the noisy values.
    const auto other_source = static_cast<std::size_t>(source_of(u + du, v + dv));
    const auto x = static_cast<float>(u + du), y = static_cast<float>(v + dv);
    if (view.disparity_at(source, x, y) > view.disparity_at(other_source, x, y) + kDisparityStep) farthest = other;
  }
  return farthest;
}

// Some neighbour is farther by a step; most pixels end here.
bool may_be_outline(const Image<float>& disparity, int u, int v) {
  if (u == 0 || v == 0 || u + 1 == disparity.width() || v + 1 == disparity.height()) return true;
  const float *here = &disparity(u, v), *above = here - disparity.width(), *below = here + disparity.width();
  return here[-1] + kDisparityStep < *here || here[1] + kDisparityStep < *here || *above + kDisparityStep < *here ||
         *below + kDisparityStep < *here;
}

}  // namespace

void mix_outlines(const StereoView& view, double probability, const Rng& rng, DisparityImage& image) {
  if (!(probability > 0)) return;
  const Image<float> before = image.disparity;
  for_rows(view.camera.height, view.threads, [&](int first, int end) {
    for (int v = first; v < end; ++v)
      for (int u = 0; u < view.camera.width; ++u) {
        if (image.source(u, v) < 0 || !may_be_outline(before, u, v)) continue;
        const float farther = behind_outline(view, before, image.source, u, v);
        if (std::isnan(farther)) continue;
        Rng draw = rng.at(view.index(u, v));
        if (draw.uniform() >= probability) continue;
        const auto share = static_cast<float>(draw.uniform());
        image.disparity(u, v) = share * before(u, v) + (1 - share) * farther;
      }
  });
}

}  // namespace binpick

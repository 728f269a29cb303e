#include "sim/noise/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binpick {

DisparityImage jittered_samples(const StereoView& view, double sigma, const Image<std::uint8_t>& hidden,
                                const Rng& rng) {
  const int width = view.camera.width, height = view.camera.height;
  DisparityImage image{Image<float>(width, height, std::numeric_limits<float>::quiet_NaN()),
                       Image<std::int32_t>(width, height, -1)};
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      double su = u, sv = v;
      if (sigma > 0) {
        Rng draw = rng.at(view.index(u, v));
        su += sigma * draw.normal();
        sv += sigma * draw.normal();
      }
      const int nu = std::clamp(static_cast<int>(std::lround(su)), 0, width - 1);
      const int nv = std::clamp(static_cast<int>(std::lround(sv)), 0, height - 1);
      const std::size_t source = view.index(nu, nv);
      if (view.exact.ids[source] == kIdNothing || hidden[source]) continue;
      image.source(u, v) = static_cast<std::int32_t>(source);
      image.disparity(u, v) =
          static_cast<float>(sigma > 0 ? view.disparity_at(source, su, sv) : view.disparity(source));
    }
  return image;
}

void grow_foreground(const StereoView& view, int radius, DisparityImage& image) {
  if (radius <= 0) return;
  const DisparityImage before = image;
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u) {
      // A pixel without a match (shadow, nothing there) still has the surface behind it.
      const std::int32_t own = before.source(u, v);
      const double behind =
          own >= 0 ? view.disparity_at(static_cast<std::size_t>(own), u, v) : view.disparity(view.index(u, v));
      double best = behind + kDisparityStep;
      for (int y = std::max(v - radius, 0); y <= std::min(v + radius, view.camera.height - 1); ++y)
        for (int x = std::max(u - radius, 0); x <= std::min(u + radius, view.camera.width - 1); ++x) {
          if (!(before.disparity(x, y) > best)) continue;  // also when NaN
          const auto source = static_cast<std::size_t>(before.source(x, y));
          // The neighbour's plane, carried over to this pixel, must still stand before it.
          if (!(view.disparity_at(source, u, v) > behind + kDisparityStep)) continue;
          best = before.disparity(x, y);
          image.disparity(u, v) = before.disparity(x, y);
          image.source(u, v) = before.source(x, y);
        }
    }
}

}  // namespace binpick

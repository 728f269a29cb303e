#include "sim/noise/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random_field.hpp"
#include "sim/noise/row_kernels.hpp"
#include "sim/noise/rows.hpp"

namespace binpick {
namespace {

// The nearest whole number of a displacement, halves upwards.
int nearest(float x) { return static_cast<int>(x + 1024.5f) - 1024; }

// Whether the largest disparity of the neighbourhood could stand before a pixel at all; most pixels end here.
class LargestAround {
 public:
  LargestAround(const Image<float>& disparity, int radius) : disparity_(disparity), radius_(radius) {}
  void load(int v) {
    const int width = disparity_.width();
    largest_.assign(static_cast<std::size_t>(width), 0.0f);
    beside_.resize(largest_.size());
    for (int y = std::max(v - radius_, 0); y <= std::min(v + radius_, disparity_.height() - 1); ++y) {
      largest_beside(beside_.data(), &disparity_(0, y), radius_, width);
      largest_of(largest_.data(), beside_.data(), width);
    }
  }
  float at(int u) const { return largest_[static_cast<std::size_t>(u)]; }

 private:
  const Image<float>& disparity_;
  int radius_;
  std::vector<float> largest_, beside_;
};

void grow_into(const StereoView& view, int radius, const DisparityImage& before, int u, int v, float behind,
               DisparityImage& image) {
  float best = behind + kDisparityStep;
  for (int y = std::max(v - radius, 0); y <= std::min(v + radius, view.camera.height - 1); ++y)
    for (int x = std::max(u - radius, 0); x <= std::min(u + radius, view.camera.width - 1); ++x) {
      if (!(before.disparity(x, y) > best)) continue;  // also when NaN
      const auto source = static_cast<std::size_t>(before.source(x, y));
      // The neighbour's plane, carried over to this pixel, must still stand before it.
      if (!(view.disparity_at(source, static_cast<float>(u), static_cast<float>(v)) > behind + kDisparityStep))
        continue;
      best = before.disparity(x, y);
      image.disparity(u, v) = before.disparity(x, y);
      image.source(u, v) = before.source(x, y);
    }
}

}  // namespace

DisparityImage jittered_samples(const StereoView& view, double sigma, const Image<std::uint8_t>& hidden,
                                const Rng& rng) {
  const int width = view.camera.width, height = view.camera.height;
  DisparityImage image{Image<float>(width, height, std::numeric_limits<float>::quiet_NaN()),
                       Image<std::int32_t>(width, height, -1)};
  const auto scale = static_cast<float>(sigma);
  for_rows(height, view.threads, [&](int first, int end) {
    std::vector<float> draws(2 * static_cast<std::size_t>(width), 0.0f);
    for (int v = first; v < end; ++v) {
      if (sigma > 0) fill_normals(rng, static_cast<std::uint64_t>(v), draws);
      for (int u = 0; u < width; ++u) {
        const float du = scale * draws[static_cast<std::size_t>(u)];
        const float dv = scale * draws[static_cast<std::size_t>(width + u)];
        const int nu = std::clamp(u + nearest(du), 0, width - 1), nv = std::clamp(v + nearest(dv), 0, height - 1);
        const std::size_t source = view.index(nu, nv);
        if (view.exact.ids[source] == kIdNothing || hidden[source]) continue;
        image.source(u, v) = static_cast<std::int32_t>(source);
        image.disparity(u, v) =
            view.disparity_beside(source, static_cast<float>(u - nu) + du, static_cast<float>(v - nv) + dv);
      }
    }
  });
  return image;
}

void grow_foreground(const StereoView& view, int radius, DisparityImage& image) {
  if (radius <= 0) return;
  const DisparityImage before = image;
  for_rows(view.camera.height, view.threads, [&](int first, int end) {
    LargestAround largest(before.disparity, radius);
    for (int v = first; v < end; ++v) {
      largest.load(v);
      for (int u = 0; u < view.camera.width; ++u) {
        // A pixel without a match (shadow, nothing there) still has the surface behind it.
        const std::int32_t own = before.source(u, v);
        const float behind =
            own >= 0 ? view.disparity_at(static_cast<std::size_t>(own), static_cast<float>(u), static_cast<float>(v))
                     : view.disparity(view.index(u, v));
        if (largest.at(u) > behind + kDisparityStep) grow_into(view, radius, before, u, v, behind, image);
      }
    }
  });
}

}  // namespace binpick

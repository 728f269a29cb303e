#include "perception/floor_mask.hpp"

#include <algorithm>
#include <vector>

namespace binpick {
namespace {

constexpr int kHalf = 2;  // px: two of a stereo matcher's correlation lengths, and less than half a small hole

/// Running sums over rows of 2 kHalf + 1 values.
struct LowHeights {
  Image<float> sum, count;
};

/// Height above the floor where it is low, and 1 there.
LowHeights low_heights(const Scene& scene, double low) {
  const Eigen::Vector3f up_C = scene.X_CB.linear().col(2).cast<float>();
  const float origin = up_C.dot(scene.X_CB.translation().cast<float>()), most = static_cast<float>(low);
  const int width = scene.depth.width(), height = scene.depth.height();
  LowHeights out{Image<float>(width, height, 0.0f), Image<float>(width, height, 0.0f)};
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const float z = scene.depth(u, v);
      if (!(z > 0)) continue;
      const float h = up_C.dot(scene.point(u, v, z)) - origin;
      if (!(std::abs(h) < most)) continue;
      out.sum(u, v) = h;
      out.count(u, v) = 1;
    }
  return out;
}

/// Sums over the window about every pixel, first along the rows, then along the columns.
Image<float> window_sums(const Image<float>& values) {
  const int width = values.width(), height = values.height();
  Image<float> rows(width, height, 0.0f), out(width, height, 0.0f);
  for (int v = 0; v < height; ++v)
    for (int u = kHalf; u < width - kHalf; ++u)
      for (int a = -kHalf; a <= kHalf; ++a) rows(u, v) += values(u + a, v);
  for (int v = kHalf; v < height - kHalf; ++v)
    for (int b = -kHalf; b <= kHalf; ++b)
      for (int u = 0; u < width; ++u) out(u, v) += rows(u, v + b);
  return out;
}

}  // namespace

void mark_low_pixels(Scene& scene, const LowCut& cut) {
  const Pose X_BC = scene.X_CB.inverse();
  const Eigen::Vector2d half = scene.bin->inner_size.head<2>() / 2 - Eigen::Vector2d::Constant(cut.wall_margin);
  const LowHeights heights = low_heights(scene, cut.low);
  const Image<float> sums = window_sums(heights.sum), counts = window_sums(heights.count);
  for (int v = kHalf; v < scene.depth.height() - kHalf; ++v)
    for (int u = kHalf; u < scene.depth.width() - kHalf; ++u) {
      if (heights.count(u, v) == 0 || counts(u, v) < kHalf) continue;
      const bool above = sums(u, v) > static_cast<float>(cut.height) * counts(u, v);
      if (above == (scene.wanted(u, v) != 0)) continue;
      const Eigen::Vector3d p_B = X_BC * scene.camera.unproject(u, v, scene.depth(u, v));
      if ((p_B.head<2>().array().abs() < half.array()).all()) scene.wanted(u, v) = above;
    }
}

}  // namespace binpick

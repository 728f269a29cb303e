#include "perception/part_view.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "core/zbuffer.hpp"

namespace binpick {
namespace {

constexpr double kNear = 0.01;  // m
constexpr int kRim = 2;         // px about the part's projection
constexpr int kReach = 3;       // px to either side, of the window that tells the outward direction

/// Of seven pixels in a row: how many are inside, and the sum of their places -3 .. 3.
struct StretchSums {
  int count = 0, places = 0;
};
std::array<StretchSums, 128> stretch_sums() {
  std::array<StretchSums, 128> out;
  for (unsigned bits = 0; bits < out.size(); ++bits)
    for (int place = -kReach; place <= kReach; ++place)
      if ((bits >> (kReach - place)) & 1u) {
        ++out[bits].count;
        out[bits].places += place;
      }
  return out;
}

}  // namespace

PartView draw_part(const PinholeCamera& camera, const SurfaceModel& model, const Pose& X_CP) {
  PartView view;
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3f::CornerType>(corner);
    const Eigen::Vector3d p_C = X_CP * model.box().corner(type).cast<double>();
    if (!(p_C.z() > kNear)) return view;
    const Eigen::Array2d pixel = camera.project(p_C).array();
    low = low.min(pixel);
    high = high.max(pixel);
  }
  const int u0 = std::max(-kRim, static_cast<int>(std::max(low.x(), -1e6)) - kRim);
  const int v0 = std::max(-kRim, static_cast<int>(std::max(low.y(), -1e6)) - kRim);
  const int u1 = std::min(camera.width - 1 + kRim, static_cast<int>(std::min(high.x(), 1e6)) + kRim);
  const int v1 = std::min(camera.height - 1 + kRim, static_cast<int>(std::min(high.y(), 1e6)) + kRim);
  if (u1 <= u0 + 2 * kRim || v1 <= v0 + 2 * kRim) return view;
  PinholeCamera crop = camera;
  crop.width = u1 - u0 + 1;
  crop.height = v1 - v0 + 1;
  crop.cx -= u0;
  crop.cy -= v0;
  ZBuffer buffer(crop, kNear);
  buffer.restrict_to({-u0, -v0, camera.width - u0, camera.height - v0});
  buffer.draw(model.shell_facing(X_CP.inverse() * Eigen::Vector3d::Zero()), X_CP, 0);
  view.u0 = u0;
  view.v0 = v0;
  view.depth = buffer.result().depth;
  for (const float z : view.depth) view.pixels += std::isfinite(z);
  return view;
}

PartView grown(const PartView& view, int px) {
  const int border = 2 * px + 1, width = view.depth.width(), height = view.depth.height();
  constexpr float kOutside = std::numeric_limits<float>::infinity();
  Image<float> wide(width + 2 * border, height + 2 * border, kOutside), rows = wide;
  for (int v = 0; v < height; ++v) std::copy_n(&view.depth(0, v), width, &wide(border, v + border));
  const int stride = wide.width();
  const auto nearest_along = [&](const Image<float>& from, Image<float>& to, int step) {
    for (int v = px; v < wide.height() - px; ++v)
      for (int k = -px; k <= px; ++k) {
        float* out = &to(px, v);
        const float* in = &from(px, v) + k * step;
        for (int i = 0; i < stride - 2 * px; ++i) out[i] = std::min(out[i], in[i]);
      }
  };
  nearest_along(wide, rows, 1);
  std::fill(wide.begin(), wide.end(), kOutside);
  nearest_along(rows, wide, stride);
  PartView out = view;
  out.u0 -= border;
  out.v0 -= border;
  out.depth = std::move(wide);
  return out;
}

std::vector<OutlinePixel> outline_of(const PartView& view) {
  // A row as bits, seven pixels about each: where they lie, summed up, is a look-up.
  static const std::array<StretchSums, 128> kSums = stretch_sums();
  const int width = view.depth.width(), height = view.depth.height(), wide = width + 2 * kReach;
  std::vector<std::uint8_t> bits(static_cast<std::size_t>(wide) * static_cast<std::size_t>(height + 2 * kReach), 0);
  for (int v = 0; v < height; ++v) {
    std::uint8_t* row = bits.data() + static_cast<std::size_t>(v + kReach) * wide;
    unsigned window = 0;  // bit 6: the pixel three to the left, bit 0: three to the right
    for (int u = -kReach; u < width + kReach; ++u) {
      const int ahead = u + kReach;
      window = ((window << 1) | (ahead < width && std::isfinite(view.depth(ahead, v)) ? 1u : 0u)) & 127u;
      row[u + kReach] = static_cast<std::uint8_t>(window);
    }
  }
  std::vector<OutlinePixel> out;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const std::uint8_t* at = bits.data() + static_cast<std::size_t>(v + kReach) * wide + u + kReach;
      const bool inside = *at & 8u, all_four = (*at & 28u) == 28u && (at[-wide] & 8u) && (at[wide] & 8u);
      if (!inside || all_four) continue;
      int x = 0, y = 0;  // what lies outside pulls outward; all offsets together sum to zero
      for (int b = -kReach; b <= kReach; ++b) {
        const StretchSums& sums = kSums[at[b * wide]];
        x -= sums.places;
        y -= b * sums.count;
      }
      if (x * x + y * y < 1) continue;  // a spike, open on both sides: no direction
      const Eigen::Vector2f outward(static_cast<float>(x), static_cast<float>(y));
      out.push_back({view.u0 + u, view.v0 + v, view.depth(u, v), outward.normalized()});
    }
  return out;
}

}  // namespace binpick

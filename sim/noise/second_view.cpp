#include "sim/noise/second_view.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/noise/rows.hpp"

namespace binpick {
namespace {

constexpr int kCells = 4;       // cells of the second image for each of its pixels
constexpr int kLeft = 1 << 16;  // px: more than any disparity

// One row of both images: x = u - d is where pixel u appears in the second one.
class RowWarp {
 public:
  explicit RowWarp(int width) : width_(width), d_(width), nearest_(static_cast<std::size_t>(width) * kCells) {}

  void load(const StereoView& view, int row) {
    for (int u = 0; u < width_; ++u) d_[u] = view.disparity(view.index(u, row));
    std::fill(nearest_.begin(), nearest_.end(), 0.0);
    for (int u = 0; u < width_; ++u)
      if (d_[u] > 0) cover(u);
  }

  bool empty(int u) const { return !(d_[u] > 0); }
  bool outside(int u) const { return u - d_[u] < -0.5; }
  bool hidden(int u) const {
    const int cell = cell_of(u - d_[u]);
    return cell >= 0 && cell < static_cast<int>(nearest_.size()) && nearest_[cell] > d_[u] + kDisparityStep;
  }

 private:
  // Rounds down; places far left of the image, which no cell has, only need to stay negative.
  static int cell_of(double x) { return static_cast<int>((x + 0.5 + kLeft) * kCells) - kLeft * kCells; }

  // A pixel's footprint reaches half way to its neighbours on the same surface, and half a pixel at the surface's end.
  void cover(int u) {
    const double x = u - d_[u];
    const auto half_way = [&](int other) {
      const bool same = other >= 0 && other < width_ && d_[other] > 0 && std::abs(d_[other] - d_[u]) <= 1.0;
      return same ? 0.5 * (x + other - d_[other]) : x + 0.5 * (other - u);
    };
    const int first = std::max(cell_of(std::min(half_way(u - 1), x)), 0);
    const int last = std::min(cell_of(std::max(half_way(u + 1), x)), static_cast<int>(nearest_.size()) - 1);
    for (int cell = first; cell <= last; ++cell) nearest_[cell] = std::max(nearest_[cell], d_[u]);
  }

  int width_;
  std::vector<double> d_;
  std::vector<double> nearest_;
};

}  // namespace

Image<std::uint8_t> hidden_from_second_view(const StereoView& view, bool same_image) {
  Image<std::uint8_t> hidden(view.camera.width, view.camera.height, 0);
  for_rows(hidden.height(), view.threads, [&](int first, int end) {
    RowWarp warp(view.camera.width);
    for (int v = first; v < end; ++v) {
      warp.load(view, v);
      for (int u = 0; u < hidden.width(); ++u)
        hidden(u, v) = !warp.empty(u) && ((same_image && warp.outside(u)) || warp.hidden(u));
    }
  });
  return hidden;
}

}  // namespace binpick

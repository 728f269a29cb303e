#include "sim/optics/subpixel_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/check.hpp"
#include "core/parallel.hpp"

namespace binpick {
namespace {

constexpr int kLane = 8;         // pixels of a window's row that are worked on at once; its end has weights of 0
constexpr int kMargin = 16;      // px around the image, the border repeated: windows need no test
constexpr int kIterations = 2;   // the second moves by less than 1/50 px
constexpr double kFarthest = 1;  // px from the matcher's result

using Lane = Eigen::Array<float, kLane, 1>;

// A float copy with a margin.
class Padded {
 public:
  explicit Padded(const Image<std::uint8_t>& image)
      : image_(image.width() + 2 * kMargin, image.height() + 2 * kMargin) {
    for (int v = 0; v < image_.height(); ++v)
      for (int u = 0; u < image_.width(); ++u)
        image_(u, v) =
            image(std::clamp(u - kMargin, 0, image.width() - 1), std::clamp(v - kMargin, 0, image.height() - 1));
  }
  const float* at(int u, int v) const { return &image_(u + kMargin, v + kMargin); }
  int left() const { return -kMargin; }
  int right() const { return image_.width() - kMargin - 1; }

 private:
  Image<float> image_;
};

// Catmull and Rom's cubic through four neighbours, at the fraction t behind the second.
Eigen::Array4f cubic_weights(float t) {
  return {0.5f * t * (-1 + t * (2 - t)), 0.5f * (2 + t * t * (-5 + 3 * t)), 0.5f * t * (1 + t * (4 - 3 * t)),
          0.5f * t * t * (t - 1)};
}

struct GreySums {
  long sum = 0, square = 0, saturated = 0;
  void add(long grey, long sign) {
    sum += sign * grey;
    square += sign * grey * grey;
    saturated += sign * (grey == 255);
  }
  void add(const GreySums& other) {
    sum += other.sum;
    square += other.square;
    saturated += other.saturated;
  }
  double variance(double n) const {
    const double mean = static_cast<double>(sum) / n;
    return static_cast<double>(square) / n - mean * mean;
  }
};

struct WindowFit {
  const Padded& left;
  const Padded& right;
  int half;
  Lane inside[2];  // 1 in the window's columns, for windows of up to two lanes

  WindowFit(const Padded& l, const Padded& r, int block) : left(l), right(r), half(block / 2) {
    for (int k = 0; k < 2 * kLane; ++k) inside[k / kLane][k % kLane] = k < block ? 1.0f : 0.0f;
  }

  // How much too large d is: eps = sum g e / sum g^2 with e = L - R(d), both less their means.
  double excess(int u, int v, double d) const {
    const double x = u - d - half;
    const int first = static_cast<int>(std::floor(x));
    if (first - 1 < right.left() || first + 2 + 2 * half + kLane > right.right())
      return std::numeric_limits<double>::quiet_NaN();
    const Eigen::Array4f w = cubic_weights(static_cast<float>(x - first));
    Lane ge = Lane::Zero(), gg = Lane::Zero(), g_sum = Lane::Zero(), e_sum = Lane::Zero();
    for (int j = -half; j <= half; ++j)
      for (int lane = 0; lane * kLane < 2 * half + 1; ++lane) {
        const auto row = [&](const float* p) { return Eigen::Map<const Lane>(p + lane * kLane); };
        const float* l = left.at(u - half, v + j);
        const float* r = right.at(first, v + j);
        const Lane g = inside[lane] * 0.5f * (row(l + 1) - row(l - 1));
        const Lane e =
            inside[lane] * (row(l) - (w[0] * row(r - 1) + w[1] * row(r) + w[2] * row(r + 1) + w[3] * row(r + 2)));
        ge += g * e;
        gg += g * g;
        g_sum += g;
        e_sum += e;
      }
    const double n = (2.0 * half + 1) * (2 * half + 1), mean_g = g_sum.sum() / n;
    return (ge.sum() - mean_g * e_sum.sum()) / std::max(gg.sum() - mean_g * g_sum.sum(), 1e-6);
  }
};

float refined(const WindowFit& fit, int u, int v, double start) {
  double d = start;
  for (int i = 0; i < kIterations; ++i) {
    const double excess = fit.excess(u, v, d);
    if (std::isnan(excess)) return static_cast<float>(start);  // at the image's edge
    d -= excess;
    if (!(std::abs(d - start) <= kFarthest)) return std::numeric_limits<float>::quiet_NaN();
  }
  return static_cast<float>(d);
}

}  // namespace

void drop_plain(const Image<std::uint8_t>& left, const StereoMatching& how, Image<float>& disparity) {
  const int half = how.block / 2, width = left.width(), height = left.height();
  const double n = static_cast<double>(how.block) * how.block;
  // Sums over columns of `block` rows, then over windows: exact in integers.
  std::vector<GreySums> columns(static_cast<std::size_t>(width));
  const auto add_row = [&](int v, long sign) {
    for (int u = 0; u < width; ++u)
      columns[static_cast<std::size_t>(u)].add(left(u, std::clamp(v, 0, height - 1)), sign);
  };
  for (int v = -half; v < half; ++v) add_row(v, 1);
  for (int v = 0; v < height; ++v) {
    add_row(v + half, 1);
    for (int u = 0; u < width; ++u) {
      GreySums window;
      for (int k = -half; k <= half; ++k)
        window.add(columns[static_cast<std::size_t>(std::clamp(u + k, 0, width - 1))]);
      if (window.variance(n) < how.contrast * how.contrast || window.saturated > how.saturated_share * n)
        disparity(u, v) = std::numeric_limits<float>::quiet_NaN();
    }
    add_row(v - half, -1);
  }
}

void fit_subpixel(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, int block, Image<float>& disparity,
                  int threads) {
  BP_CHECK(block % 2 == 1 && block >= 3 && block <= 15, block);
  const Padded padded_left(left), padded_right(right);
  const WindowFit fit(padded_left, padded_right, block);
  parallel_for(static_cast<std::size_t>(left.height()), threads, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < left.width(); ++u)
      if (!std::isnan(disparity(u, v))) disparity(u, v) = refined(fit, u, v, disparity(u, v));
  });
}

}  // namespace binpick

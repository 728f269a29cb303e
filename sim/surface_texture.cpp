#include "sim/surface_texture.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace binpick {

SurfaceTexture::SurfaceTexture(const Image<std::uint8_t>& grey, const Eigen::Vector2d& size)
    : width_(grey.width()), height_(grey.height()), size_(size) {
  BP_CHECK(!grey.empty() && size.minCoeff() > 0);
  const auto stride = static_cast<std::size_t>(width_) + 1;
  sums_.assign(stride * (static_cast<std::size_t>(height_) + 1), 0.0);
  for (int v = 0; v < height_; ++v) {
    double row = 0;
    for (int u = 0; u < width_; ++u) {
      row += grey(u, v) / 255.0;
      const std::size_t i = (static_cast<std::size_t>(v) + 1) * stride + static_cast<std::size_t>(u) + 1;
      sums_[i] = sums_[i - stride] + row;
    }
  }
}

double SurfaceTexture::integral(double x, double y) const {
  // The integral of squares of one value each is bilinear within a texel, so this is exact.
  const double cx = std::clamp(x, 0.0, double(width_)), cy = std::clamp(y, 0.0, double(height_));
  const int u = std::min(static_cast<int>(cx), width_ - 1), v = std::min(static_cast<int>(cy), height_ - 1);
  const double a = cx - u, b = cy - v;
  const auto stride = static_cast<std::size_t>(width_) + 1;
  const double* top = &sums_[static_cast<std::size_t>(v) * stride + static_cast<std::size_t>(u)];
  const double* below = top + stride;
  return (1 - b) * ((1 - a) * top[0] + a * top[1]) + b * ((1 - a) * below[0] + a * below[1]);
}

double SurfaceTexture::mean(const Eigen::Vector2d& p_O, const Eigen::Vector2d& half) const {
  constexpr double kLeast = 1e-3;  // texels: a point is a small box, or differences of sums lose their digits
  const double x = (p_O.x() / size_.x() + 0.5) * width_, y = (0.5 - p_O.y() / size_.y()) * height_;
  const double hx = std::max(half.x() / size_.x() * width_, kLeast);
  const double hy = std::max(half.y() / size_.y() * height_, kLeast);
  const double x0 = std::clamp(x - hx, 0.0, width_ - kLeast), x1 = std::clamp(x + hx, x0 + kLeast, double(width_));
  const double y0 = std::clamp(y - hy, 0.0, height_ - kLeast), y1 = std::clamp(y + hy, y0 + kLeast, double(height_));
  const double sum = integral(x1, y1) - integral(x0, y1) - integral(x1, y0) + integral(x0, y0);
  return std::clamp(sum / ((x1 - x0) * (y1 - y0)), 0.0, 1.0);
}

}  // namespace binpick

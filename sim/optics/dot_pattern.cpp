#include "sim/optics/dot_pattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace binpick {
namespace {

constexpr double kTexelsPerRadius = 1.6;
constexpr int kReach = 6;  // texels: 3.75 standard deviations

}  // namespace

DotPattern::DotPattern(const DotPatternConfig& config, Seed seed)
    : config_(config),
      texel_(config.radius / kTexelsPerRadius),
      image_(static_cast<int>(2 * config.half_x / texel_) + 2, static_cast<int>(2 * config.half_y / texel_) + 2, 0.0f) {
  const Rng rng = seed.rng();
  const int columns = static_cast<int>(2 * config.half_x / config.pitch) + 1;
  const int rows = static_cast<int>(2 * config.half_y / config.pitch) + 1;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      Rng cell = rng.at(static_cast<std::uint64_t>(row) * static_cast<std::uint64_t>(columns) + column);
      if (cell.uniform() >= config.density) continue;
      const double x = (column + cell.uniform()) * config.pitch, y = (row + cell.uniform()) * config.pitch;
      add_spot(x / texel_, y / texel_, cell.uniform(0.6, 1));
    }
}

void DotPattern::add_spot(double x, double y, double brightness) {
  const int u0 = static_cast<int>(std::lround(x)) - kReach, v0 = static_cast<int>(std::lround(y)) - kReach;
  std::array<double, 2 * kReach + 1> along_u, along_v;
  const auto weight = [](double offset) {
    return std::exp(-0.5 * offset * offset / (kTexelsPerRadius * kTexelsPerRadius));
  };
  for (int k = 0; k <= 2 * kReach; ++k) {
    along_u[static_cast<std::size_t>(k)] = weight(u0 + k - x);
    along_v[static_cast<std::size_t>(k)] = brightness * weight(v0 + k - y);
  }
  for (int j = std::max(0, -v0); j <= 2 * kReach && v0 + j < image_.height(); ++j)
    for (int i = std::max(0, -u0); i <= 2 * kReach && u0 + i < image_.width(); ++i)
      image_(u0 + i, v0 + j) +=
          static_cast<float>(along_u[static_cast<std::size_t>(i)] * along_v[static_cast<std::size_t>(j)]);
}

double DotPattern::at(double x, double y) const {
  const double u = (x + config_.half_x) / texel_, v = (y + config_.half_y) / texel_;
  if (!(u >= 0 && v >= 0 && u < image_.width() - 1 && v < image_.height() - 1)) return 0;
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const double a = u - i, b = v - j;
  return (1 - b) * ((1 - a) * image_(i, j) + a * image_(i + 1, j)) +
         b * ((1 - a) * image_(i, j + 1) + a * image_(i + 1, j + 1));
}

}  // namespace binpick

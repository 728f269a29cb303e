#include "sim/noise/median.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/noise/row_kernels.hpp"
#include "sim/noise/rows.hpp"

namespace binpick {
namespace {

float median_at(const Image<float>& image, int u, int v) {
  std::array<float, 9> values;
  std::size_t count = 0;
  for (int y = std::max(v - 1, 0); y <= std::min(v + 1, image.height() - 1); ++y)
    for (int x = std::max(u - 1, 0); x <= std::min(u + 1, image.width() - 1); ++x)
      if (!std::isnan(image(x, y))) values[count++] = image(x, y);
  for (std::size_t i = 1; i < count; ++i)  // insertion: nine values at most
    for (std::size_t k = i; k > 0 && values[k] < values[k - 1]; --k) std::swap(values[k], values[k - 1]);
  return values[(count - 1) / 2];
}

}  // namespace

Image<float> median_3x3(const Image<float>& image, int threads) {
  const int width = image.width(), height = image.height();
  Image<float> out(width, height, std::nanf(""));
  for_rows(height, threads, [&](int first, int end) {
    for (int v = first; v < end; ++v) {
      if (v > 0 && v + 1 < height) median_row(&out(0, v), &image(0, v - 1), &image(0, v), &image(0, v + 1), width);
      for (int u = 0; u < width; ++u)  // borders, and beside pixels without a match
        if (std::isnan(out(u, v)) && !std::isnan(image(u, v))) out(u, v) = median_at(image, u, v);
    }
  });
  return out;
}

}  // namespace binpick

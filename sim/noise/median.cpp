#include "sim/noise/median.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace binpick {

Image<float> median_3x3(const Image<float>& image) {
  Image<float> out = image;
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u) {
      if (std::isnan(image(u, v))) continue;
      std::array<float, 9> values;
      std::size_t count = 0;
      for (int y = std::max(v - 1, 0); y <= std::min(v + 1, image.height() - 1); ++y)
        for (int x = std::max(u - 1, 0); x <= std::min(u + 1, image.width() - 1); ++x)
          if (!std::isnan(image(x, y))) values[count++] = image(x, y);
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);
      std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
      out(u, v) = *middle;
    }
  return out;
}

}  // namespace binpick

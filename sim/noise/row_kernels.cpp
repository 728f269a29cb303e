#include "sim/noise/row_kernels.hpp"

#include <limits>

namespace binpick {
namespace {

inline void order(float& a, float& b) {
  const float low = a < b ? a : b;
  b = a < b ? b : a;
  a = low;
}

}  // namespace

void scale_row(float* out, const float* a, float scale, int count) {
  for (int i = 0; i < count; ++i) out[i] = scale * a[i];
}

void add_row(float* out, const float* a, float scale, int count) {
  for (int i = 0; i < count; ++i) out[i] += scale * a[i];
}

void add_pair(float* out, const float* a, const float* b, float scale, int count) {
  for (int i = 0; i < count; ++i) out[i] += scale * (a[i] + b[i]);
}

void median_row(float* out, const float* above, const float* here, const float* below, int count) {
  for (int i = 1; i < count - 1; ++i) {
    float a0 = above[i - 1], a1 = here[i - 1], a2 = below[i - 1];
    float b0 = above[i], b1 = here[i], b2 = below[i];
    float c0 = above[i + 1], c1 = here[i + 1], c2 = below[i + 1];
    const float sum = ((a0 + a1) + (a2 + b0)) + ((b1 + b2) + (c0 + c1)) + c2;
    // Columns in order; the median is that of the largest low, the middle middle and the smallest high.
    order(a0, a1), order(a1, a2), order(a0, a1);
    order(b0, b1), order(b1, b2), order(b0, b1);
    order(c0, c1), order(c1, c2), order(c0, c1);
    float low = a0 > b0 ? a0 : b0, high = a2 < b2 ? a2 : b2;
    low = low > c0 ? low : c0;
    high = high < c2 ? high : c2;
    order(a1, b1), order(b1, c1), order(a1, b1);
    order(low, b1), order(b1, high), order(low, b1);
    out[i] = sum == sum ? b1 : std::numeric_limits<float>::quiet_NaN();
  }
}

void largest_beside(float* out, const float* a, int radius, int count) {
  for (int i = 0; i < count; ++i) out[i] = a[i] > 0 ? a[i] : 0;
  for (int k = 1; k <= radius; ++k) {
    for (int i = k; i < count; ++i) out[i] = a[i - k] > out[i] ? a[i - k] : out[i];
    for (int i = 0; i < count - k; ++i) out[i] = a[i + k] > out[i] ? a[i + k] : out[i];
  }
}

void largest_of(float* out, const float* a, int count) {
  for (int i = 0; i < count; ++i) out[i] = a[i] > out[i] ? a[i] : out[i];
}

}  // namespace binpick

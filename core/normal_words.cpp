#include "core/normal_words.hpp"

#include <bit>
#include <cmath>

namespace binpick {
namespace {

// ln u for u in (0, 1]: u = 2^e (1 + f) with 1 + f near 1, and ln(1 + f) = 2 artanh(f / (2 + f)), whose argument stays
// below 0.172: five terms leave 3e-9.
inline float logarithm(float u) {
  const auto bits = std::bit_cast<std::int32_t>(u);
  const float half = std::bit_cast<float>((bits & 0x007fffff) | 0x3f000000);  // 0.5 .. 1
  const bool low = half < 0.70710678f;
  const float f = low ? half + half - 1 : half - 1;
  const auto e = static_cast<float>((bits >> 23) - 126 - (low ? 1 : 0));
  const float s = f / (2 + f), q = s * s;
  const float series = 1 + q * (1.0f / 3 + q * (1.0f / 5 + q * (1.0f / 7 + q * (1.0f / 9))));
  return e * 0.69314718f + 2 * s * series;
}

}  // namespace

void normals_from_words(const std::uint32_t* a, const std::uint32_t* b, float* x, float* y) {
  for (int i = 0; i < kNormalLanes; ++i) {
    const float u = (static_cast<float>(static_cast<std::int32_t>(a[i] >> 1)) + 0.5f) * 0x1.0p-31f;
    const float square = -2 * logarithm(u);
    const float radius = std::sqrt(square > 0 ? square : 0.0f);
    // Two bits choose the quarter turn, thirty the angle t of -pi/4 .. pi/4 in it; Taylor series leave 3e-9.
    const auto fraction = static_cast<std::int32_t>(b[i] & 0x3fffffffu) - 0x20000000;
    const float t = static_cast<float>(fraction) * static_cast<float>(1.5707963267948966 / 1073741824.0), q = t * t;
    const float sine = t * (1 - q * (1.0f / 6 - q * (1.0f / 120 - q * (1.0f / 5040 - q * (1.0f / 362880)))));
    const float cosine = 1 - q * (0.5f - q * (1.0f / 24 - q * (1.0f / 720 - q * (1.0f / 40320))));
    // A quarter turn swaps both and turns a sign; written with bits, so that no lane takes a way of its own.
    const auto c = std::bit_cast<std::uint32_t>(cosine), d = std::bit_cast<std::uint32_t>(sine);
    const std::uint32_t quarter = b[i] >> 30, swap = (c ^ d) & (0u - (quarter & 1u));
    const std::uint32_t sign_x = ((quarter + 1) & 2u) << 30, sign_y = (quarter & 2u) << 30;
    x[i] = radius * std::bit_cast<float>((c ^ swap) ^ sign_x);
    y[i] = radius * std::bit_cast<float>((d ^ swap) ^ sign_y);
  }
}

}  // namespace binpick

#include "core/random_field.hpp"

#include <algorithm>

#include "core/normal_words.hpp"

namespace binpick {

void fill_normals(const Rng& rng, std::uint64_t row, std::span<float> out) {
  Rng words = rng.at(row);
  std::uint32_t a[kNormalLanes], b[kNormalLanes];
  float values[2 * kNormalLanes];
  for (std::size_t i = 0; i < out.size(); i += std::size(values)) {
    for (int k = 0; k < kNormalLanes; ++k) {
      a[k] = words.next_u32();
      b[k] = words.next_u32();
    }
    normals_from_words(a, b, values, values + kNormalLanes);
    std::copy_n(values, std::min(std::size(values), out.size() - i), out.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void fill_uniforms(const Rng& rng, std::uint64_t row, std::span<float> out) {
  Rng words = rng.at(row);
  for (float& value : out) value = static_cast<float>(words.next_u32() >> 8) * 0x1.0p-24f;
}

}  // namespace binpick

// Random numbers for whole fields (images), a row at a time: cheaper than one Rng::at() a value, in single precision,
// and the same bits on every processor. A row depends only on the stream and its number, not on the order of rows.
#pragma once

#include <cstdint>
#include <span>

#include "core/random.hpp"

namespace binpick {

/// Mean 0, standard deviation 1. The values are made from the words of rng.at(row).
void fill_normals(const Rng& rng, std::uint64_t row, std::span<float> out);

/// [0, 1), 24 bits, from the words of rng.at(row).
void fill_uniforms(const Rng& rng, std::uint64_t row, std::span<float> out);

}  // namespace binpick

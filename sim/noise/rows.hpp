// Private to sim: every row of an image on a stated number of threads, a few neighbouring rows at a time.
#pragma once

#include <algorithm>
#include <cstddef>

#include "core/parallel.hpp"

namespace binpick {

/// Calls body(first, end) for stretches of rows that together are 0 .. height-1. Their size does not depend on
/// `threads`.
template <class Body>
void for_rows(int height, int threads, const Body& body) {
  constexpr int kRows = 16;
  const auto stretches = static_cast<std::size_t>((height + kRows - 1) / kRows);
  parallel_for(stretches, threads, [&](std::size_t i) {
    const int first = static_cast<int>(i) * kRows;
    body(first, std::min(first + kRows, height));
  });
}

}  // namespace binpick

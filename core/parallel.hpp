// For each index, on a stated number of threads; results are written by index, so the answer does not depend on the
// number.
#pragma once

#include <cstddef>
#include <functional>

namespace binpick {

/// Calls body(i) for i in [0, count). The first exception (lowest index) is rethrown after all have ended.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

}  // namespace binpick

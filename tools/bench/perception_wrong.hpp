// A part that is not there: every part of the scenes looked for in the heaps of every other. Whatever comes back is
// wrong.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/bench/perception_bench.hpp"

namespace binpick {

/// A row for every ordered pair and sensor: its part is what was looked for, its scene the heap. Throws SpecError when
/// a scene has parts of several kinds.
std::vector<PerceptionRow> bench_wrong_parts(const PerceptionBenchConfig& config, ProgressSink& progress);

/// A Markdown table a sensor: poses, views with any, largest score; and the sum.
std::string wrong_parts_table(std::span<const PerceptionRow> rows);

}  // namespace binpick

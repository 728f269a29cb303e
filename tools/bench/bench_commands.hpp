// The subjects of `binpick bench` that have a file of their own.
#pragma once

#include "tools/commands.hpp"

namespace binpick {

Action add_bench_perception(CLI::App& bench);
Action add_bench_score(CLI::App& bench);
Action add_bench_physics(CLI::App& bench);
Action add_bench_suction(CLI::App& bench);
Action add_bench_heaps(CLI::App& bench);
Action add_bench_planning(CLI::App& bench);
Action add_bench_metrics(CLI::App& bench);
Action add_bench_merge(CLI::App& bench);

}  // namespace binpick

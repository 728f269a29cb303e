// `binpick bench gate`.
#pragma once

#include "tools/commands.hpp"

namespace binpick {

Action add_bench_gate(CLI::App& bench);

}  // namespace binpick

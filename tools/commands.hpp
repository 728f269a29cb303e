// The subcommands of the program. Each adds itself to the parser and returns what to run when it was chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <utility>

namespace binpick {

using Action = std::function<int()>;  ///< returns the exit code of ARCHITECTURE section 14

Action add_trial(CLI::App& app);
Action add_campaign(CLI::App& app);
Action add_worker(CLI::App& app);
Action add_report(CLI::App& app);
Action add_compare(CLI::App& app);
Action add_merge(CLI::App& app);
Action add_gate(CLI::App& app);
Action add_bench(CLI::App& app);
Action add_bop(CLI::App& app);
Action add_budget(CLI::App& app);
Action add_calibrate(CLI::App& app);
Action add_paper(CLI::App& app);
Action add_check(CLI::App& app);
Action add_estimate(CLI::App& app);
Action add_render(CLI::App& app);
Action add_list(CLI::App& app);
Action add_part(CLI::App& app);
Action add_query(CLI::App& app);
Action add_sweep(CLI::App& app);
Action add_validate(CLI::App& app);
Action add_verify(CLI::App& app);
Action add_view(CLI::App& app);

/// --sensor NAME[:PRESET], as ScenarioOverrides has it.
void add_sensor_option(CLI::App& command, std::string& sensor);

/// "A:B" means seeds A .. B-1. Throws SpecError.
std::pair<std::uint64_t, std::uint64_t> parse_seeds(const std::string& text);
/// "I/N", 1 <= I <= N. Throws SpecError.
std::pair<int, int> parse_shard(const std::string& text);

}  // namespace binpick

// binpick bench planning SCENE: processor time of planning a pick, beside what is asked for (median 60 ms, p99 500 ms).

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <tuple>

#include "core/file_io.hpp"
#include "evaluation/statistics.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/planning_bench.hpp"

namespace binpick {
namespace {

struct Options {
  PlanningBenchConfig bench;
  std::string seeds = "0:3", json;
  bool rows = false;
};

double degrees(double angle) { return angle * 180 / std::numbers::pi; }

std::vector<double> milliseconds(const std::vector<PlanningCost>& costs) {
  std::vector<double> ms;
  for (const PlanningCost& cost : costs) ms.push_back(1e3 * cost.cpu);
  return ms;
}

void print_row(const PlanningCost& cost) {
  std::printf("seed %llu pick %d: %6.1f ms, %zu estimates, %zu candidates given up, ",
              static_cast<unsigned long long>(cost.seed), cost.pick, 1e3 * cost.cpu, cost.estimates, cost.rejected);
  if (!cost.planned) {
    std::printf("%s\n", cost.reason.c_str());
    return;
  }
  std::printf(
      "tilt %.0f, at most %.0f, %.0f deg; approach %.2f, lift %.2f, place %.2f, back %.2f, all %.2f s; %s%s%s\n",
      degrees(cost.tilt_pick), degrees(cost.tilt_carry), degrees(cost.tilt_place), cost.approach, cost.lift, cost.place,
      cost.back, cost.executed, cost.outcome.c_str(), cost.ended.empty() ? "" : ", ", cost.ended.c_str());
}

void print_costs(const std::vector<PlanningCost>& costs, bool rows) {
  std::map<std::string, int> outcomes;
  std::size_t planned = 0;
  for (const PlanningCost& cost : costs) {
    planned += cost.planned;
    ++outcomes[cost.planned ? cost.outcome : "no plan"];
    if (rows) print_row(cost);
  }
  const std::vector<double> ms = milliseconds(costs);
  if (ms.empty()) return;
  std::printf(
      "%zu looks, %zu planned: CPU ms of planning: median %.1f (at most 60, aim 20), p99 %.1f (at most 500), "
      "largest %.1f\n",
      ms.size(), planned, quantile(ms, 0.5), quantile(ms, 0.99), quantile(ms, 1));
  for (const auto& [outcome, count] : outcomes) std::printf("  %s: %d\n", outcome.c_str(), count);
}

void write_costs(const std::vector<PlanningCost>& costs, const std::string& path) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const PlanningCost& cost : costs)
    rows.push_back({{"seed", cost.seed},
                    {"pick", cost.pick},
                    {"plan_cpu_ms", 1e3 * cost.cpu},
                    {"planned", cost.planned},
                    {"estimates", cost.estimates},
                    {"rejected", cost.rejected},
                    {"reason", cost.reason},
                    {"outcome", cost.outcome},
                    {"ended", cost.ended},
                    {"tilt_rad", {{"pick", cost.tilt_pick}, {"carry", cost.tilt_carry}, {"place", cost.tilt_place}}},
                    {"motion_s",
                     {{"approach", cost.approach},
                      {"lift", cost.lift},
                      {"place", cost.place},
                      {"back", cost.back},
                      {"vacuum", cost.vacuum},
                      {"executed", cost.executed}}}});
  write_file(path, nlohmann::ordered_json{{"rows", rows}}.dump(2) + "\n");
}

}  // namespace

Action add_bench_planning(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("planning", "processor time of planning a pick");
  command->add_option("scene", options->bench.scene, "scene file; its estimates are the truth here")->required();
  command->add_option("--seeds", options->seeds, "A:B, heaps of seeds A to B - 1");
  command->add_option("--picks", options->bench.picks, "looks of every heap")->check(CLI::Range(1, 1000));
  command->add_flag("--rows", options->rows, "a line for every look");
  command->add_option("--json", options->json, "file for the figures");
  return [options] {
    std::tie(options->bench.first_seed, options->bench.last_seed) = parse_seeds(options->seeds);
    const std::vector<PlanningCost> costs = bench_planning(options->bench);
    print_costs(costs, options->rows);
    if (!options->json.empty()) write_costs(costs, options->json);
    return 0;
  };
}

}  // namespace binpick

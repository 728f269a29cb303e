// binpick bench physics: what the physics costs in processor seconds of one core, and what of it bare Bullet would
// take.

#include <algorithm>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "evaluation/statistics.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/physics_picks.hpp"
#include "tools/bench/physics_settle.hpp"

namespace binpick {
namespace {

struct Options {
  PicksBenchConfig picks;
  std::string json, seeds;
  std::vector<std::string> heaps = {"scenes/bearing_bin.yaml", "scenes/bolt_bin.yaml", "scenes/bracket_bin.yaml"};
  std::vector<int> counts;  ///< of parts; empty: heaps are not timed
  bool rows = false;
};

void print_picks(const std::vector<PickCost>& costs, bool rows) {
  std::vector<double> cpu, simulated;
  for (const PickCost& c : costs) {
    cpu.push_back(c.cpu);
    simulated.push_back(c.simulated);
    if (!rows) continue;
    std::printf("seed %llu pick %d, %2d in bin: %6.3f s for %5.2f s, peak %8.2f N, swing %.3f, moved %d, %s %s\n",
                static_cast<unsigned long long>(c.seed), c.pick, c.left_in_bin, c.cpu, c.simulated, c.peak_force,
                c.swing, c.neighbours_moved, c.outcome.c_str(), c.reason.c_str());
  }
  std::printf("%zu picks: CPU s median %.3f, p95 %.3f, mean %.3f; simulated s median %.2f\n", costs.size(),
              quantile(cpu, 0.5), quantile(cpu, 0.95), mean(cpu), quantile(simulated, 0.5));
}

/// Median and range of one figure over heaps.
struct Spread {
  double low, median, high;
};
Spread spread(const std::vector<SettleCost>& costs, const std::function<double(const SettleCost&)>& figure) {
  std::vector<double> values;
  for (const SettleCost& cost : costs) values.push_back(figure(cost));
  return {quantile(values, 0), quantile(values, 0.5), quantile(values, 1)};
}

void print_heaps(const std::vector<SettleCost>& costs) {
  const SettleCost& first = costs.front();
  const Spread cpu = spread(costs, [](const SettleCost& c) { return c.cpu; });
  const Spread simulated = spread(costs, [](const SettleCost& c) { return c.simulated; });
  const Spread rate = spread(costs, [](const SettleCost& c) { return static_cast<double>(c.steps) / c.cpu; });
  const Spread bare = spread(costs, [](const SettleCost& c) { return static_cast<double>(c.steps) / c.bare_cpu; });
  const Spread ours_real = spread(costs, [](const SettleCost& c) { return c.simulated / c.cpu; });
  const Spread bare_real = spread(costs, [](const SettleCost& c) { return c.simulated / c.bare_cpu; });
  const Spread ratio = spread(costs, [](const SettleCost& c) { return c.ratio(); });
  std::size_t at_rest = 0, escaped = 0, different = 0;
  double penetration = 0;
  for (const SettleCost& c : costs) {
    at_rest += c.settled ? 1 : 0, escaped += c.escaped, different += c.different > 0 ? 1 : 0;
    penetration = std::max(penetration, c.penetration);
  }
  std::printf(
      "%-14s %3d parts of %2zu pieces, %d and %d iterations, %zu heaps: CPU s %.3f (%.3f-%.3f) for %.2f s; steps/s "
      "%.0f, bare %.0f; x real time %.2f, bare %.2f; ours/bare %.3f (%.3f-%.3f), ",
      first.scene.c_str(), first.parts, first.pieces, first.fine_iterations, first.coarse_iterations, costs.size(),
      cpu.median, cpu.low, cpu.high, simulated.median, rate.median, bare.median, ours_real.median, bare_real.median,
      ratio.median, ratio.low, ratio.high);
  if (different > 0)
    std::printf("bits DIFFER in %zu; ", different);
  else
    std::printf("same bits; ");
  std::printf("at rest %zu, %zu outside, deepest %.3f mm\n", at_rest, escaped, 1e3 * penetration);
  std::fflush(stdout);
}

std::vector<SettleCost> time_heaps(const Options& options) {
  std::vector<SettleCost> all;
  for (const int count : options.counts)
    for (const std::string& scene : options.heaps) {
      std::vector<SettleCost> costs;
      for (std::uint64_t seed = options.picks.first_seed; seed < options.picks.last_seed; ++seed)
        costs.push_back(bench_settle(scene, count, seed));
      print_heaps(costs);
      all.insert(all.end(), costs.begin(), costs.end());
    }
  return all;
}

nlohmann::ordered_json json_of(const std::vector<SettleCost>& heaps, const std::vector<PickCost>& picks) {
  nlohmann::ordered_json json;
  json["heaps"] = nlohmann::ordered_json::array();
  json["picks"] = nlohmann::ordered_json::array();
  for (const SettleCost& c : heaps)
    json["heaps"].push_back({{"scene", c.scene},
                             {"parts", c.parts},
                             {"pieces", c.pieces},
                             {"fine_iterations", c.fine_iterations},
                             {"coarse_iterations", c.coarse_iterations},
                             {"seed", c.seed},
                             {"cpu_s", c.cpu},
                             {"bare_cpu_s", c.bare_cpu},
                             {"ratio", c.ratio()},
                             {"steps", c.steps},
                             {"steps_differ", c.different},
                             {"simulated_s", c.simulated},
                             {"settled", c.settled},
                             {"escaped", c.escaped},
                             {"penetration_m", c.penetration}});
  for (const PickCost& c : picks)
    json["picks"].push_back({{"seed", c.seed},
                             {"pick", c.pick},
                             {"in_bin", c.left_in_bin},
                             {"outcome", c.outcome},
                             {"cpu_s", c.cpu},
                             {"simulated_s", c.simulated},
                             {"peak_force_n", c.peak_force},
                             {"swing_rad", c.swing},
                             {"neighbours_moved", c.neighbours_moved}});
  return json;
}

int run(const Options& options) {
  const std::vector<SettleCost> heaps = time_heaps(options);
  std::vector<PickCost> picks;
  if (options.picks.picks > 0) {
    picks = bench_picks(options.picks);
    print_picks(picks, options.rows);
  }
  if (!options.json.empty()) write_file(options.json, json_of(heaps, picks).dump(2) + "\n");
  return 0;
}

}  // namespace

Action add_bench_physics(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("physics", "processor time of settling and of an executed pick");
  command->add_option("--scene", options->picks.scene, "scene whose picks are executed");
  command->add_option("--picks", options->picks.picks, "picks of every heap")->check(CLI::Range(0, 1000));
  command->add_option("--seeds", options->seeds, "A:B, heaps of the picks and heaps that are timed");
  command->add_option("--heaps", options->heaps, "scenes whose first part is dropped");
  command->add_option("--counts", options->counts, "parts of a heap, one or several; none: heaps are not timed");
  command->add_flag("--awake{false},--freeze{true}", options->picks.freeze_far, "physics.freeze_far of the picks");
  command->add_flag("--rows", options->rows, "every pick");
  command->add_option("--json", options->json, "file for the figures");
  return [options] {
    if (!options->seeds.empty())
      std::tie(options->picks.first_seed, options->picks.last_seed) = parse_seeds(options->seeds);
    return run(*options);
  };
}

}  // namespace binpick

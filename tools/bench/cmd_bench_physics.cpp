// binpick bench physics: what the physics costs in processor seconds of one core.

#include <cstdio>
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

std::vector<SettleCost> time_heaps(const Options& options) {
  std::vector<SettleCost> costs;
  for (const int count : options.counts)
    for (const std::string& scene : options.heaps) {
      const SettleCost c = bench_settle(scene, count, options.picks.first_seed);
      std::printf(
          "%-14s %3d parts of %2zu pieces, %d iterations: %7.3f CPU s for %5.2f s (%.2f x real time), %s, %zu outside, "
          "deepest %.3f mm\n",
          c.scene.c_str(), c.parts, c.pieces, c.iterations, c.cpu, c.simulated, c.simulated / c.cpu,
          c.settled ? "at rest" : "NOT at rest", c.escaped, 1e3 * c.penetration);
      std::fflush(stdout);
      costs.push_back(c);
    }
  return costs;
}

nlohmann::ordered_json json_of(const std::vector<SettleCost>& heaps, const std::vector<PickCost>& picks) {
  nlohmann::ordered_json json;
  json["heaps"] = nlohmann::ordered_json::array();
  json["picks"] = nlohmann::ordered_json::array();
  for (const SettleCost& c : heaps)
    json["heaps"].push_back({{"scene", c.scene},
                             {"parts", c.parts},
                             {"pieces", c.pieces},
                             {"iterations", c.iterations},
                             {"cpu_s", c.cpu},
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
  const std::vector<PickCost> picks = bench_picks(options.picks);
  print_picks(picks, options.rows);
  if (!options.json.empty()) write_file(options.json, json_of(heaps, picks).dump(2) + "\n");
  return 0;
}

}  // namespace

Action add_bench_physics(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("physics", "processor time of settling and of an executed pick");
  command->add_option("--scene", options->picks.scene, "scene whose picks are executed");
  command->add_option("--picks", options->picks.picks, "picks of every heap")->check(CLI::Range(0, 1000));
  command->add_option("--seeds", options->seeds, "A:B, heaps of the picks");
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

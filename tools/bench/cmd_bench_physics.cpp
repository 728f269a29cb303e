// binpick bench physics: what the physics costs in processor seconds of one core.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "evaluation/statistics.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/physics_picks.hpp"

namespace binpick {
namespace {

struct Options {
  PicksBenchConfig picks;
  std::string json, seeds;
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

int run(const Options& options) {
  print_picks(bench_picks(options.picks), options.rows);
  return 0;
}

}  // namespace

Action add_bench_physics(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("physics", "processor time of settling and of an executed pick");
  command->add_option("--scene", options->picks.scene, "scene whose picks are executed");
  command->add_option("--picks", options->picks.picks, "picks of every heap")->check(CLI::Range(0, 1000));
  command->add_option("--seeds", options->seeds, "A:B, heaps of the picks");
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

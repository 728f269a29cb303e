// binpick sweep SWEEP.yaml --out DIR: one scenario over factors, the same seeds in every cell (docs/sweeps.md). What is
// there already is not run again.

#include <iostream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/progress.hpp"
#include "tools/commands.hpp"
#include "tools/sweep_picture.hpp"
#include "trials/sweep_run.hpp"

namespace binpick {
namespace {

struct Options {
  std::string file, shard, json;
  CampaignOptions campaign;
  double memory_mb = 4096;
  bool list = false;
};

int list_cells(const SweepSetup& sweep) {
  for (std::size_t c = 0; c < sweep.plan.cells.size(); ++c) cell_scenario(sweep, c);  // what cannot be meant is said
  std::cout << sweep_plan_text(sweep.plan) << std::flush;
  return 0;
}

int run(Options options) {
  const SweepSetup sweep = read_sweep(options.file);
  if (options.list) return list_cells(sweep);
  if (options.campaign.out.empty()) throw SpecError("--out: is missing (or --list, to see the cells)");
  if (!options.shard.empty()) std::tie(options.campaign.shard, options.campaign.shards) = parse_shard(options.shard);
  options.campaign.limits.memory = 1e6 * options.memory_mb;
  StderrProgress progress;
  const SweepRun ran = run_sweep(sweep, options.campaign, "/proc/self/exe", progress);
  if (ran.worker_exit != 0) return ran.worker_exit;
  const SweepResult result = read_sweep_result(options.campaign.out);
  write_sweep_files(result, options.campaign.out);
  if (!options.json.empty()) write_file(options.json, read_file(options.campaign.out + "/sweep.json"));
  std::cout << sweep_text(result) << std::flush;
  std::cerr << "tables and heat maps: " << options.campaign.out << std::endl;
  return ran.interrupted ? 130 : ran.failed > 0 ? 5 : 0;
}

}  // namespace

Action add_sweep(CLI::App& app) {
  auto options = std::make_shared<Options>();
  options->campaign.pictured = 0;
  CLI::App* command =
      app.add_subcommand("sweep", "a campaign in every cell of a plan: factor tables, heat maps, best cell");
  command->add_option("sweep", options->file, "sweep file (YAML)")->required();
  command->add_option("--out", options->campaign.out, "folder; every cell is a run folder in it");
  command->add_flag("--list", options->list, "only check every cell's scene and list the cells");
  command->add_option("--workers", options->campaign.workers, "worker processes")->check(CLI::Range(1, 256));
  command->add_option("--shard", options->shard, "I/N: only part I (1 to N) of the trials, chosen by hash");
  command->add_option("--json", options->json, "file for the figures (as sweep.json in the folder)");
  command->add_option("--timeout", options->campaign.limits.timeout, "s that one trial may take")
      ->check(CLI::Range(0.1, 1e6));
  command->add_option("--memory", options->memory_mb, "MB of memory that one worker may use")
      ->check(CLI::Range(100.0, 1e7));
  command->add_option("--pictured", options->campaign.pictured,
                      "looks pictured per trial (failed picks always are); -1: no pictures at all");
  return [options] { return run(*options); };
}

}  // namespace binpick

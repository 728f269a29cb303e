// binpick merge RUN... --out DIR: the runs of a campaign's or a sweep's parts as one. Exit code 7: a seed came with two
// results; 3: seeds are missing.

#include <iostream>

#include "evaluation/report.hpp"
#include "tools/commands.hpp"
#include "tools/sweep_picture.hpp"
#include "trials/run_merge.hpp"
#include "trials/sweep_run.hpp"

namespace binpick {
namespace {

struct Options {
  std::vector<std::string> runs;
  std::string out, seeds;
};

void list(const char* what, const std::vector<std::uint64_t>& seeds) {
  std::cerr << what;
  for (const std::uint64_t seed : seeds) std::cerr << " " << seed;
  std::cerr << std::endl;
}

int run_sweeps(const Options& options) {
  const SweepMerge merge = merge_sweeps(options.runs, options.out);
  if (!merge.conflicts.empty()) {
    std::cerr << "error: these trials came with different results, nothing was merged:";
    for (const std::string& trial : merge.conflicts) std::cerr << "\n  " << trial;
    std::cerr << std::endl;
    return 7;
  }
  const SweepResult result = read_sweep_result(options.out);
  write_sweep_files(result, options.out);
  std::cout << sweep_text(result) << std::flush;
  if (merge.missing == 0) return 0;
  std::cerr << merge.missing << " trials are missing, the first is " << merge.first_missing << std::endl;
  return 3;
}

int run(const Options& options) {
  if (is_sweep_folder(options.runs.front())) return run_sweeps(options);
  std::pair<std::uint64_t, std::uint64_t> seeds{0, 0};
  if (!options.seeds.empty()) seeds = parse_seeds(options.seeds);
  const MergeResult result = merge_runs(options.runs, options.out, seeds.first, seeds.second);
  if (!result.conflicts.empty()) {
    list("error: these seeds came with different results, nothing was merged:", result.conflicts);
    return 7;
  }
  std::cout << terminal_table(result.summary) << std::flush;
  if (result.missing.empty()) return 0;
  list("missing seeds:", result.missing);
  return 3;
}

}  // namespace

Action add_merge(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("merge", "the runs of a campaign's or sweep's shards as one");
  command->add_option("run", options->runs, "run folders")->required();
  command->add_option("--out", options->out, "run folder to write")->required();
  command->add_option("--seeds", options->seeds, "A:B, what should be there; what is missing is listed (exit code 3)");
  return [options] { return run(*options); };
}

}  // namespace binpick

// binpick gate SCENE --baseline F: runs the scene on the baseline's seeds until the verdict is certain (docs/gate.md).
// binpick gate SCENE --baseline F --renew --seeds A:B writes the baseline instead.

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "tools/commands.hpp"
#include "tools/verdict_files.hpp"
#include "trials/gate.hpp"

namespace binpick {
namespace {

struct Options {
  GateOptions gate;
  std::string margins, seeds;
  VerdictFiles files;
  bool renew = false;
};

// The run folder: the one that was asked for, else one of our own, which goes when all is well.
class RunFolder {
 public:
  explicit RunFolder(const std::string& asked) : path_(asked), own_(asked.empty()) {
    if (!own_) return;
    path_ = (std::filesystem::temp_directory_path() / "binpick-gate-XXXXXX").string();
    if (!::mkdtemp(path_.data())) throw StorageError(path_ + ": cannot create");
  }
  ~RunFolder() {
    std::error_code ignored;
    if (own_ && !kept_) std::filesystem::remove_all(path_, ignored);
  }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  const std::string& path() const { return path_; }
  void keep() {
    kept_ = true;
    if (own_) std::cerr << "records: " << path_ << std::endl;
  }

 private:
  std::string path_;
  bool own_, kept_ = false;
};

int renew(const Options& options, const std::string& folder) {
  CampaignOptions campaign = options.gate.campaign;
  campaign.out = folder;
  std::tie(campaign.first_seed, campaign.end_seed) = parse_seeds(options.seeds);
  if (std::filesystem::exists(folder + "/records"))
    throw SpecError(folder + ": holds records already: a baseline is made in a folder of its own");
  StderrProgress progress;
  const CampaignResult ran = run_campaign(campaign, "/proc/self/exe", progress);
  if (ran.worker_exit != 0) return ran.worker_exit;
  if (ran.interrupted) return 130;
  const PileSet set = pile_set(folder, read_records(folder));
  for (const PileFigures& pile : set.piles)
    if (pile.crashed) {
      std::cerr << "error: seed " << pile.seed << " crashed: no baseline is written" << std::endl;
      return 5;
    }
  write_file(options.gate.baseline, baseline_text(set));
  std::cout << options.gate.baseline << ": " << set.piles.size() << " piles of " << set.scenario << std::endl;
  return 0;
}

void write_files(const VerdictFiles& files, const GateResult& result) {
  write_verdict({files.junit, files.markdown, ""}, result.comparison);
  if (files.json.empty()) return;
  auto json = nlohmann::ordered_json::parse(comparison_json(result.comparison));
  json["gate"] = {{"seeds", result.seeds}, {"max_seeds", result.max_seeds}, {"looks", result.looks}};
  write_file(files.json, json.dump(2) + "\n");
}

int gate(Options options, RunFolder& folder) {
  options.gate.rules = read_gate_rules(options.margins);
  options.gate.campaign.out = folder.path();
  StderrProgress progress;
  const GateResult result = run_gate(options.gate, "/proc/self/exe", progress);
  if (result.worker_exit != 0) return result.worker_exit;
  if (result.interrupted) return 130;
  std::cout << comparison_text(result.comparison) << "  stopped after " << result.seeds << " of at most "
            << result.max_seeds << " seeds, look " << result.looks << std::endl;
  write_files(options.files, result);
  const int code = exit_code(result.comparison);
  if (code != 0) folder.keep();
  return code;
}

int run(const Options& options) {
  if (options.renew == options.seeds.empty())
    throw SpecError("--renew and --seeds A:B go together: they say which piles a new baseline holds");
  RunFolder folder(options.gate.campaign.out);
  return options.renew ? renew(options, folder.path()) : gate(options, folder);
}

}  // namespace

Action add_gate(CLI::App& app) {
  auto options = std::make_shared<Options>();
  options->gate.campaign.pictured = -1;
  CLI::App* command = app.add_subcommand("gate", "a scene against its baseline, until the verdict is certain");
  command->add_option("scene", options->gate.campaign.scene, "scene file (YAML)")->required();
  command->add_option("--baseline", options->gate.baseline, "baseline file, or a run folder")->required();
  command->add_option("--max-seeds", options->gate.plan.max_seeds, "at most so many of the baseline's seeds")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--block", options->gate.plan.block, "seeds between two looks")->check(CLI::Range(1, 1000000));
  command->add_option("--margins", options->margins, "YAML: alpha, confidence, and per metric its margin");
  command->add_option("--workers", options->gate.campaign.workers, "worker processes")->check(CLI::Range(1, 256));
  command->add_option("--out", options->gate.campaign.out,
                      "run folder; without it records of a passed gate are not kept");
  command->add_flag("--renew", options->renew, "write the baseline instead of comparing with it");
  command->add_option("--seeds", options->seeds, "with --renew: A:B, the seeds A to B-1");
  add_verdict_options(*command, options->files);
  return [options] { return run(*options); };
}

}  // namespace binpick

// binpick campaign SCENE --seeds A:B --workers K --out DIR: many trials, records, summary, report, pictures.

#include <charconv>
#include <cstdio>
#include <iostream>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "evaluation/report.hpp"
#include "tools/commands.hpp"
#include "trials/campaign.hpp"
#include "trials/run_merge.hpp"

namespace binpick {
namespace {

struct Options {
  CampaignOptions campaign;
  std::string seeds = "5000:5010";
  std::string shard;
  double memory_mb = 4096;
};

/// What the runner took of its workers' time: starting them, pipes, disk, and waiting for the last one.
std::string cost(const CampaignOptions& options, const CampaignResult& result) {
  const double held = result.wall * options.workers;
  char text[160];
  std::snprintf(text, sizeof text, "%.1f s of trials in %.1f s on %d worker%s: %.1f %% went to running them",
                result.trial_wall, result.wall, options.workers, options.workers == 1 ? "" : "s",
                100 * (1 - result.trial_wall / held));
  return text;
}

bool is_empty_shard(const CampaignOptions& campaign) {
  for (std::uint64_t seed = campaign.first_seed; seed < campaign.end_seed; ++seed)
    if (in_shard(seed, campaign.shard, campaign.shards)) return false;
  return true;
}

int run(Options options) {
  std::tie(options.campaign.first_seed, options.campaign.end_seed) = parse_seeds(options.seeds);
  if (!options.shard.empty()) std::tie(options.campaign.shard, options.campaign.shards) = parse_shard(options.shard);
  if (is_empty_shard(options.campaign)) {
    std::cerr << "shard " << options.shard << " has none of these seeds: there is nothing to do" << std::endl;
    return 0;
  }
  options.campaign.limits.memory = 1e6 * options.memory_mb;
  StderrProgress progress;
  const CampaignResult result = run_campaign(options.campaign, "/proc/self/exe", progress);
  if (result.worker_exit != 0) return result.worker_exit;
  std::cout << terminal_table(result.summary) << std::flush;
  if (result.wall > 0) std::cerr << cost(options.campaign, result) << std::endl;
  std::cerr << "records, tables and pictures: " << options.campaign.out << "/report.html" << std::endl;
  if (result.interrupted) return 130;
  return result.summary.failed > 0 ? 5 : 0;
}

}  // namespace

std::pair<int, int> parse_shard(const std::string& text) {
  int index = 0, count = 0;
  const char* end = text.data() + text.size();
  const auto [slash, bad_index] = std::from_chars(text.data(), end, index);
  if (bad_index == std::errc() && slash != end && *slash == '/') {
    const auto [stop, bad_count] = std::from_chars(slash + 1, end, count);
    if (bad_count == std::errc() && stop == end && index >= 1 && index <= count && count <= 1000000)
      return {index, count};
  }
  throw SpecError("--shard '" + text + "': must be I/N with 1 <= I <= N");
}

std::pair<std::uint64_t, std::uint64_t> parse_seeds(const std::string& text) {
  const std::size_t colon = text.find(':');
  std::uint64_t first = 0, end = 0;
  const auto read = [](std::string_view part, std::uint64_t& value) {
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return !part.empty() && error == std::errc() && stop == part.data() + part.size();
  };
  const std::string_view view = text;
  if (colon == std::string::npos || !read(view.substr(0, colon), first) || !read(view.substr(colon + 1), end) ||
      end <= first)
    throw SpecError("--seeds '" + text + "': must be A:B with A < B, meaning the seeds A to B-1");
  if (end - first > 1000000) throw SpecError("--seeds '" + text + "': more than a million trials in one campaign");
  return {first, end};
}

Action add_campaign(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("campaign", "many trials: records, intervals, report and pictures");
  command->add_option("scene", options->campaign.scene, "scene file (YAML)")->required();
  command->add_option("--seeds", options->seeds, "A:B, the seeds A to B-1")->required();
  command->add_option("--out", options->campaign.out, "run folder")->required();
  add_sensor_option(*command, options->campaign.overrides.sensor);
  command->add_option("--workers", options->campaign.workers, "worker processes")->check(CLI::Range(1, 256));
  command->add_option("--shard", options->shard, "I/N: of these seeds only those of part I (1 to N), chosen by hash");
  command->add_option("--timeout", options->campaign.limits.timeout, "s that one trial may take")
      ->check(CLI::Range(0.1, 1e6));
  command->add_option("--memory", options->memory_mb, "MB of memory that one worker may use")
      ->check(CLI::Range(100.0, 1e7));
  command->add_option("--worker-trials", options->campaign.limits.trials, "trials after which a worker is replaced")
      ->check(CLI::Range(1, 1000000000));
  command->add_option("--shuffle", options->campaign.shuffle, "N: seeds are given out in an order drawn from N");
  command->add_option("--plant", options->campaign.plant, "faults planted on purpose")->group("");  // docs/campaigns.md
  command->add_option("--pictured", options->campaign.pictured,
                      "looks pictured per trial (failed picks always are); -1: no pictures at all");
  return [options] { return run(*options); };
}

}  // namespace binpick

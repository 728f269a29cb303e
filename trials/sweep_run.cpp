#include "trials/sweep_run.hpp"

#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "trials/run_merge.hpp"

namespace binpick {
namespace {

/// One bar over all cells.
class CellProgress : public ProgressSink {
 public:
  CellProgress(ProgressSink& sink, std::size_t total) : sink_(sink), total_(total) {}
  void begin(const std::string& label, std::size_t trials) {
    label_ = label;
    trials_ = trials;
  }
  void end() { before_ += trials_; }
  void update(std::size_t done, std::size_t pending, const std::string& note) override {
    sink_.update(before_ + trials_ - pending + done, total_, note + ", " + label_);
  }

 private:
  ProgressSink& sink_;
  std::string label_;
  std::size_t total_, before_ = 0, trials_ = 0;
};

std::size_t seeds_of(const CampaignOptions& campaign) {
  std::size_t count = 0;
  for (std::uint64_t seed = campaign.first_seed; seed < campaign.end_seed; ++seed)
    count += in_shard(seed, campaign.shard, campaign.shards) ? 1 : 0;
  return count;
}

/// The campaigns of the cells; the scenes of those that this shard has something of are written, once all can be meant.
std::vector<CampaignOptions> campaigns_of(const SweepSetup& sweep, const CampaignOptions& options) {
  std::vector<CampaignOptions> campaigns;
  std::vector<std::string> scenes;
  for (std::size_t c = 0; c < sweep.plan.cells.size(); ++c) {
    const std::string& folder = sweep.plan.cells[c].folder;
    CampaignOptions campaign = options;
    campaign.out = options.out + "/" + folder;
    campaign.scene = campaign.out + "/scenario.yaml";
    campaign.first_seed = sweep.plan.first_seed;
    campaign.end_seed = sweep.plan.end_seed;
    campaign.shard = cell_shard(folder, options.shard, options.shards);
    campaigns.push_back(campaign);
    scenes.push_back(expanded_yaml(cell_scenario(sweep, c), campaign.out));
  }
  for (std::size_t c = 0; c < campaigns.size(); ++c) {
    if (seeds_of(campaigns[c]) == 0) continue;
    make_folder(campaigns[c].out);
    write_file(campaigns[c].scene, scenes[c]);
  }
  return campaigns;
}

SweepResult result_of(const SweepPlan& plan, const std::string& folder) {
  std::vector<SweepRecords> records;
  for (const SweepCellPlan& cell : plan.cells) {
    const std::string run = folder + "/" + cell.folder;
    const bool ran = std::filesystem::is_directory(run + "/records");
    records.push_back(sweep_records(ran ? read_records(run) : std::vector<TrialRecord>{}));
  }
  return sweep_result(plan, records);
}

bool same_plan(const SweepPlan& a, const SweepPlan& b) {
  const auto text = [](const SweepPlan& plan) {
    return sweep_json(sweep_result(plan, std::vector<SweepRecords>(plan.cells.size())));
  };
  return text(a) == text(b);
}

}  // namespace

int cell_shard(const std::string& cell_folder, int shard, int shards) {
  const std::uint64_t turn = Seed{}.child("sweep_shard").child(cell_folder).key % static_cast<std::uint64_t>(shards);
  return 1 + static_cast<int>((static_cast<std::uint64_t>(shard - 1) + turn) % static_cast<std::uint64_t>(shards));
}

SweepRun run_sweep(const SweepSetup& sweep, const CampaignOptions& options, const std::string& program,
                   ProgressSink& progress) {
  const std::vector<CampaignOptions> campaigns = campaigns_of(sweep, options);
  write_file(options.out + "/sweep.json", sweep_json(result_of(sweep.plan, options.out)));
  std::size_t total = 0;
  for (const CampaignOptions& campaign : campaigns) total += seeds_of(campaign);
  CellProgress cells(progress, total);
  SweepRun run;
  for (std::size_t c = 0; c < campaigns.size(); ++c) {
    const std::size_t seeds = seeds_of(campaigns[c]);
    if (seeds == 0) continue;
    cells.begin(cell_label(sweep.plan.cells[c]), seeds);
    const CampaignResult result = run_campaign(campaigns[c], program, cells);
    cells.end();
    run.failed += result.summary.failed;
    run.interrupted = result.interrupted;
    run.worker_exit = result.worker_exit;
    if (run.interrupted || run.worker_exit != 0) break;
  }
  progress.finish();
  return run;
}

bool is_sweep_folder(const std::string& folder) { return std::filesystem::is_regular_file(folder + "/sweep.json"); }

SweepResult read_sweep_result(const std::string& folder) { return result_of(read_sweep_plan(folder), folder); }

SweepMerge merge_sweeps(std::span<const std::string> folders, const std::string& out) {
  if (std::filesystem::exists(out))
    throw SpecError(out + ": is there already: a merged sweep gets a folder of its own");
  const SweepPlan plan = read_sweep_plan(folders.front());
  for (const std::string& folder : folders)
    if (!same_plan(plan, read_sweep_plan(folder)))
      throw SpecError(folder + ": holds another sweep than " + folders.front() + " (factors, cells or seeds differ)");
  SweepMerge merge;
  const auto named = [](const SweepCellPlan& cell, std::uint64_t seed) {
    return cell.folder + " seed " + std::to_string(seed);
  };
  for (const SweepCellPlan& cell : plan.cells) {
    std::vector<std::string> runs;
    for (const std::string& folder : folders)
      if (const std::string run = folder + "/" + cell.folder; std::filesystem::is_directory(run + "/records"))
        runs.push_back(run);
    MergeResult merged;
    if (runs.empty())
      for (std::uint64_t seed = plan.first_seed; seed < plan.end_seed; ++seed) merged.missing.push_back(seed);
    else
      merged = merge_runs(runs, out + "/" + cell.folder, plan.first_seed, plan.end_seed);
    for (const std::uint64_t seed : merged.conflicts) merge.conflicts.push_back(named(cell, seed));
    if (merge.missing == 0 && !merged.missing.empty()) merge.first_missing = named(cell, merged.missing.front());
    merge.missing += merged.missing.size();
  }
  if (merge.conflicts.empty())
    write_file(out + "/sweep.json", sweep_json(result_of(plan, out)));
  else
    std::filesystem::remove_all(out);
  return merge;
}

}  // namespace binpick

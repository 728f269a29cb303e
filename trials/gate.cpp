#include "trials/gate.hpp"

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "core/log.hpp"

namespace binpick {
namespace {

// Campaigns run ranges of seeds.
void check_baseline(const PileSet& base) {
  const std::uint64_t first = base.piles.front().seed;
  for (std::size_t i = 0; i < base.piles.size(); ++i) {
    if (base.piles[i].seed == first + i) continue;
    throw SpecError(base.name + ": seed " + std::to_string(first + i) +
                    " is missing: a gate runs the seeds of its baseline without gaps");
  }
}

// Records that are there already may be another build's, and would be taken for this one's.
void check_folder(const std::string& folder) {
  if (std::filesystem::exists(folder + "/records")) {
    throw SpecError(folder + ": holds records already: a gate starts in a folder of its own");
  }
}

}  // namespace

GateResult run_gate(const GateOptions& options, const std::string& program, ProgressSink& progress) {
  const PileSet base = read_piles(options.baseline);
  check_baseline(base);
  check_folder(options.campaign.out);
  GatePlan plan = options.plan;
  plan.max_seeds = std::min(plan.max_seeds, base.piles.size());
  GateResult result;
  result.max_seeds = plan.max_seeds;
  const std::vector<std::size_t> sizes = look_sizes(plan);
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    CampaignOptions campaign = options.campaign;
    campaign.first_seed = base.piles.front().seed;
    campaign.end_seed = campaign.first_seed + sizes[k];
    const CampaignResult ran = run_campaign(campaign, program, progress);
    result.interrupted = ran.interrupted;
    result.worker_exit = ran.worker_exit;
    if (ran.interrupted || ran.worker_exit != 0) return result;
    PileSet fresh = pile_set(campaign.out, read_records(campaign.out));
    fresh.replay = campaign.scene;
    result.comparison = compare_first(base, fresh, sizes[k], options.rules, look_at(plan, options.rules, k));
    result.seeds = sizes[k];
    result.looks = k + 1;
    if (is_certain(result.comparison, k + 1 == sizes.size())) break;
    log_line(LogLevel::kInfo, "look " + std::to_string(k + 1) + " of " + std::to_string(sizes.size()) + ": " +
                                  sentence(result.comparison));
  }
  return result;
}

}  // namespace binpick

#include "trials/verification.hpp"

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "core/random.hpp"
#include "trials/environment.hpp"
#include "trials/trial.hpp"

namespace binpick {
namespace {

/// The sample does not depend on how many records there are beside it, nor on their order.
std::vector<TrialRecord> sampled(std::vector<TrialRecord> records, std::size_t sample) {
  std::erase_if(records, [](const TrialRecord& record) { return failure_of(record).has_value(); });
  const auto rank = [](const TrialRecord& record) { return Seed{record.seed.key}.child("verify").key; };
  std::sort(records.begin(), records.end(),
            [&](const TrialRecord& a, const TrialRecord& b) { return rank(a) < rank(b); });
  records.resize(std::min(records.size(), sample));
  std::sort(records.begin(), records.end(),
            [](const TrialRecord& a, const TrialRecord& b) { return a.seed.key < b.seed.key; });
  return records;
}

}  // namespace

Verification verify_run(const std::string& run_folder, std::size_t sample, ProgressSink& progress) {
  if (!std::filesystem::is_directory(run_folder + "/records"))
    throw SpecError(run_folder + ": is not a run folder: no records/ in it");
  const std::vector<TrialRecord> records = sampled(read_records(run_folder), sample);
  if (records.empty()) throw SpecError(run_folder + ": holds no records");
  Scenario scenario = read_scenario(run_folder + "/scenario.yaml");
  TrialContext context = make_trial_context(scenario);
  Verification result;
  for (const TrialRecord& record : records) {
    if (record.scenario_hash != context.hash)
      throw SpecError(run_folder + ": seed " + std::to_string(record.seed.key) + " is of another scenario (" +
                      record.scenario_hash + ") than scenario.yaml (" + context.hash +
                      "): a file it names has changed");
    result.same_build = result.same_build && record.build == build_id();
    const TrialRecord again = run_trial(scenario, record.seed, context);
    result.seeds.push_back(record.seed.key);
    if (const auto difference = first_difference(figures_of(record), figures_of(again)))
      result.differences.push_back(*difference);
    progress.update(result.seeds.size(), records.size(), std::to_string(result.differences.size()) + " differ");
  }
  progress.finish();
  return result;
}

}  // namespace binpick

#include "trials/run_merge.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/random.hpp"
#include "trials/campaign.hpp"
#include "trials/run_store.hpp"

namespace binpick {
namespace {

void check_same(const TrialRecord& first, const TrialRecord& other) {
  const auto refuse = [&](const char* what, const std::string& a, const std::string& b) {
    throw SpecError("merge: seed " + std::to_string(other.seed.key) + " is of another " + what + " (" + b +
                    ") than seed " + std::to_string(first.seed.key) + " (" + a + ")");
  };
  if (first.scenario_hash != other.scenario_hash) refuse("scenario", first.scenario_hash, other.scenario_hash);
  if (first.build != other.build) refuse("build of the program", first.build, other.build);
}

/// Of two results of one seed the one to keep; false: they contradict each other.
bool take(TrialRecord& kept, const TrialRecord& other) {
  const bool kept_failed = failure_of(kept).has_value(), other_failed = failure_of(other).has_value();
  if (kept_failed != other_failed) {
    if (kept_failed) kept = other;
    return true;
  }
  if (!kept_failed && record_hash(kept) != record_hash(other)) return false;
  if (to_json_line(other) < to_json_line(kept)) kept = other;
  return true;
}

void write_run(const std::string& source, const std::string& out, std::span<const TrialRecord> records) {
  make_folder(out + "/records");
  std::string text;
  for (const TrialRecord& record : records) text += to_json_line(record) + "\n";
  write_file(out + "/records/records.jsonl", text);
  write_file(out + "/scenario.yaml", expanded_yaml(read_scenario(source + "/scenario.yaml"), out));
  write_file(out + "/environment.json", read_file(source + "/environment.json"));
}

}  // namespace

bool in_shard(std::uint64_t seed, int index, int count) {
  return Seed{seed}.child("shard").key % static_cast<std::uint64_t>(count) == static_cast<std::uint64_t>(index - 1);
}

MergedRecords merge_records(std::span<const std::vector<TrialRecord>> runs) {
  std::map<std::uint64_t, TrialRecord> by_seed;
  MergedRecords merged;
  for (const std::vector<TrialRecord>& run : runs)
    for (const TrialRecord& record : run) {
      if (!by_seed.empty()) check_same(by_seed.begin()->second, record);
      const auto [place, fresh] = by_seed.emplace(record.seed.key, record);
      if (!fresh && !take(place->second, record)) merged.conflicts.push_back(record.seed.key);
    }
  std::sort(merged.conflicts.begin(), merged.conflicts.end());
  merged.conflicts.erase(std::unique(merged.conflicts.begin(), merged.conflicts.end()), merged.conflicts.end());
  for (auto& [seed, record] : by_seed) merged.records.push_back(std::move(record));
  return merged;
}

MergeResult merge_runs(std::span<const std::string> runs, const std::string& out, std::uint64_t first_seed,
                       std::uint64_t end_seed) {
  if (std::filesystem::exists(out + "/records"))
    throw SpecError(out + ": holds records already: a merged run gets a folder of its own");
  std::vector<std::vector<TrialRecord>> records;
  for (const std::string& run : runs) {
    if (!std::filesystem::is_directory(run + "/records"))
      throw SpecError(run + ": is not a run folder: no records/ in it");
    records.push_back(read_records(run));
  }
  MergedRecords merged = merge_records(records);
  MergeResult result;
  result.conflicts = std::move(merged.conflicts);
  if (!result.conflicts.empty()) return result;
  if (merged.records.empty()) throw SpecError("merge: there is no record in any of the runs");
  std::size_t k = 0;
  for (std::uint64_t seed = first_seed; seed < end_seed; ++seed) {
    while (k < merged.records.size() && merged.records[k].seed.key < seed) ++k;
    if (k == merged.records.size() || merged.records[k].seed.key != seed) result.missing.push_back(seed);
  }
  write_run(runs.front(), out, merged.records);
  result.summary = write_reports(out, 0);
  return result;
}

}  // namespace binpick

#include "trials/run_merge.hpp"

#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/random.hpp"
#include "trials/campaign.hpp"
#include "trials/scenario.hpp"

namespace binpick {
namespace {

constexpr std::size_t kBlock = std::size_t{64} << 20;  // bytes of lines that are written at once

/// The kept lines, by seed, without holding them all.
void write_lines(const MergeIndex& index, const std::string& path) {
  const std::string part = path + ".part";
  std::error_code error;
  std::filesystem::remove(part, error);
  std::string block;
  for (const auto& [seed, kept] : index.seeds()) {
    block += read_bytes(kept.file, kept.offset, kept.bytes) + "\n";
    if (block.size() < kBlock) continue;
    append_file(part, block);
    block.clear();
  }
  append_file(part, block);
  std::filesystem::rename(part, path, error);
  if (error) throw StorageError(path + ": cannot rename into place: " + error.message());
}

void write_run(const std::string& source, const std::string& out, const MergeIndex& index) {
  make_folder(out + "/records");
  write_lines(index, out + "/records/records.jsonl");
  write_file(out + "/scenario.yaml", expanded_yaml(read_scenario(source + "/scenario.yaml"), out));
  write_file(out + "/environment.json", read_file(source + "/environment.json"));
}

std::vector<std::uint64_t> missing_seeds(const MergeIndex& index, std::uint64_t first, std::uint64_t end) {
  std::vector<std::uint64_t> missing;
  for (std::uint64_t seed = first; seed < end; ++seed)
    if (!index.seeds().count(seed)) missing.push_back(seed);
  return missing;
}

}  // namespace

bool in_shard(std::uint64_t seed, int index, int count) {
  return Seed{seed}.child("shard").key % static_cast<std::uint64_t>(count) == static_cast<std::uint64_t>(index - 1);
}

void MergeIndex::add(const TrialRecord& record, const RecordLine& line) {
  const std::uint64_t seed = record.seed.key;
  const auto refuse = [&](const char* what, const std::string& mine, const std::string& first) {
    throw SpecError("merge: seed " + std::to_string(seed) + " is of another " + what + " (" + mine + ") than seed " +
                    std::to_string(first_) + " (" + first + ")");
  };
  if (seeds_.empty()) {
    first_ = seed;
    scenario_hash_ = record.scenario_hash;
    build_ = record.build;
  }
  if (record.scenario_hash != scenario_hash_) refuse("scenario", record.scenario_hash, scenario_hash_);
  if (record.build != build_) refuse("build of the program", record.build, build_);
  const Kept mine{record_hash(record), failure_of(record).has_value(), line.file, line.offset, line.text.size()};
  const auto [place, fresh] = seeds_.emplace(seed, mine);
  if (fresh) return;
  Kept& kept = place->second;
  if (kept.failed != mine.failed) {
    if (kept.failed) kept = mine;
  } else if (!mine.failed && kept.hash != mine.hash) {
    conflicts_.insert(seed);
  } else if (line.text < read_bytes(kept.file, kept.offset, kept.bytes)) {
    kept = mine;
  }
}

MergeResult merge_runs(std::span<const std::string> runs, const std::string& out, std::uint64_t first_seed,
                       std::uint64_t end_seed) {
  if (std::filesystem::exists(out + "/records"))
    throw SpecError(out + ": holds records already: a merged run gets a folder of its own");
  MergeIndex index;
  for (const std::string& run : runs) {
    if (!std::filesystem::is_directory(run + "/records"))
      throw SpecError(run + ": is not a run folder: no records/ in it");
    for_each_record(run, [&](TrialRecord&& record, const RecordLine& line) { index.add(record, line); });
  }
  MergeResult result;
  result.conflicts.assign(index.conflicts().begin(), index.conflicts().end());
  if (!result.conflicts.empty()) return result;
  if (index.seeds().empty()) throw SpecError("merge: there is no record in any of the runs");
  result.missing = missing_seeds(index, first_seed, end_seed);
  const std::filesystem::path kept = index.seeds().begin()->second.file;  // a run that has a record has a scenario
  write_run(kept.parent_path().parent_path().string(), out, index);
  result.summary = write_reports(out, 0);
  return result;
}

}  // namespace binpick

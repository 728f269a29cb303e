#include "evaluation/trial_record.hpp"

#include <algorithm>

#include "core/hash.hpp"
#include "evaluation/json_archive.hpp"
#include "evaluation/record_fields.hpp"

namespace binpick {
namespace {

std::uint64_t hash_of(const std::string& text) { return Hasher().bytes(text.data(), text.size()).value(); }

}  // namespace

std::optional<TrialFailure> failure_of(const TrialRecord& record) {
  if (record.failure) return record.failure;
  const bool broken = std::any_of(record.picks.begin(), record.picks.end(),
                                  [](const PickRecord& pick) { return pick.outcome == PickOutcome::kInternalError; });
  return broken || !record.error.empty() ? std::optional(TrialFailure::kInternalError) : std::nullopt;
}

std::string canonical_line(const TrialRecord& record) {
  JsonWriter writer;
  record::trial_fields(writer, record);
  return dumped(writer.json);
}

std::uint64_t record_hash(const TrialRecord& record) { return hash_of(canonical_line(record)); }

std::string to_json_line(const TrialRecord& record) {
  std::string line = canonical_line(record);
  const std::uint64_t hash = hash_of(line);
  JsonWriter rest;
  rest.hash("hash", hash);
  record::run_fields(rest, record);
  record::seen_fields(rest, record);
  JsonWriter wall;
  record::wall_fields(wall, record);
  rest.json["wall"] = std::move(wall.json);
  line.back() = ',';  // the closing brace
  line += dumped(rest.json).substr(1);
  line.pop_back();
  return line + record::kSumKey + hex(hash_of(line)) + "\"}";
}

}  // namespace binpick

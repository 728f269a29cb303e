// A line of a run's records: as it stands, and with the hash that fits its values, so that what lies behind the check
// of the hash is reached too. What was accepted is written and read back.
#include "evaluation/json_archive.hpp"
#include "evaluation/pile_figures.hpp"
#include "evaluation/record_fields.hpp"
#include "evaluation/summary.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace binpick::fuzz {
namespace {

void read(const std::string& line) {
  TrialRecord record;
  if (!accepts("records.jsonl:1: ", [&] { record = trial_record_from_json(line, "records.jsonl:1"); })) return;
  const std::string written = to_json_line(record);
  const TrialRecord again = trial_record_from_json(written, "written.jsonl:1");
  if (to_json_line(again) != written) finding("not the same read back", written);
  PileSet set;
  set.piles = {figures_of(record)};
  baseline_from(baseline_text(set), "baseline.jsonl");
  summary_json(summarise({&record, 1}, 1));
}

/// The line with its own hash; empty when its values cannot be read.
std::string with_hash(const std::string& line) {
  nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object()) return "";
  TrialRecord record;
  JsonReader reader(json, "records.jsonl:1: ");
  if (!accepts("records.jsonl:1: ", [&] { record::trial_fields(reader, record); })) return "";
  json["hash"] = hex(record_hash(record));
  json.erase("sum");
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace
}  // namespace binpick::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string line = binpick::fuzz::text_of(data, size);
  binpick::fuzz::read(line);
  const std::string whole = binpick::fuzz::with_hash(line);
  if (!whole.empty()) binpick::fuzz::read(whole);
  return 0;
}

// Reading records back, strictly: a missing, unknown or ill-typed key, another schema or a hash that does not fit the
// values is an error that names file, line and key.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "evaluation/json_archive.hpp"
#include "evaluation/record_fields.hpp"
#include "evaluation/record_lines.hpp"
#include "evaluation/trial_record.hpp"

namespace binpick {
namespace {

using Visit = std::function<void(TrialRecord&&, const RecordLine&)>;

void read_lines(const std::filesystem::path& path, std::map<std::uint64_t, std::string>& places, const Visit& visit) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw AssetError(path.string() + ": cannot open");
  RecordLine line{path.string(), 0, ""};
  for (std::size_t number = 1; std::getline(stream, line.text); ++number) {
    const std::string place = line.file + ":" + std::to_string(number);
    if (stream.eof())
      throw SpecError(place + ": the last line is incomplete, its writer was cut off; delete that line to go on");
    TrialRecord record = trial_record_from_json(line.text, place);
    const auto [first, fresh] = places.emplace(record.seed.key, place);
    if (!fresh)
      throw SpecError(place + ": seed " + std::to_string(first->first) + " is recorded already at " + first->second);
    visit(std::move(record), line);
    line.offset += line.text.size() + 1;
  }
  if (stream.bad()) throw AssetError(line.file + ": cannot read");
}

/// A record's own hash says that nobody altered it, not that its counts fit together: rates must not leave 0 .. 1.
void check_counts(const TrialRecord& record, const JsonReader& reader) {
  if (record.placed < 0 || record.placed > record.dropped) reader.fail("placed", "does not lie in 0 .. dropped");
  for (std::size_t i = 0; i < record.picks.size(); ++i) {
    const PoseCheck& check = record.picks[i].check;
    const std::string pick = "picks[" + std::to_string(i) + "].";
    if (std::max({check.found, check.found_tight, check.found_2mm}) > check.visible)
      reader.fail(pick + "visible", "is less than found");
    if (check.right > check.counted) reader.fail(pick + "counted", "is less than right");
  }
}

void check_sum(const std::string& line, JsonReader& reader) {
  std::uint64_t sum = 0;
  reader.hash("sum", sum);
  const std::size_t at = line.rfind(record::kSumKey);
  if (at == std::string::npos || Hasher().bytes(line.data(), at).value() != sum)
    reader.fail("sum", "does not fit the line: the record was altered or damaged");
}

}  // namespace

TrialRecord trial_record_from_json(const std::string& line, const std::string& place) {
  const nlohmann::json json = parsed_line(line, place);
  TrialRecord record;
  JsonReader reader(json, place + ": ");
  int schema = 0;
  reader("schema", schema);
  if (schema != kRecordSchema) {
    reader.fail("schema", std::to_string(schema) + " is not " + std::to_string(kRecordSchema) + ", which is read here");
  }
  record::trial_fields(reader, record);
  std::uint64_t hash = 0;
  reader.hash("hash", hash);
  const std::size_t picks = record.picks.size();
  if (hash != record_hash(record)) reader.fail("hash", "does not fit the values: the record was altered or damaged");
  check_counts(record, reader);
  record::run_fields(reader, record);
  const bool has_seen = json.contains("seen");  // lines of older versions have none
  if (has_seen) record::seen_fields(reader, record);
  if (record.picks.size() != picks) reader.fail("seen", "is not as long as the list of picks");
  JsonReader wall(reader.at("wall"), place + ": wall.");
  record::wall_fields(wall, record);
  wall.finish();
  const bool summed = json.contains("sum");  // lines of older versions are not
  if (summed) reader.at("sum");
  reader.finish();
  if (record.picks.size() != picks) wall.fail("picks", "is not as long as the list of picks");
  if (summed) check_sum(line, reader);
  return record;
}

void for_each_record(const std::string& run_folder, const Visit& visit) {
  const std::filesystem::path folder = std::filesystem::path(run_folder) / "records";
  std::error_code error;
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".jsonl") paths.push_back(entry.path());
  }
  if (error) throw AssetError(folder.string() + ": cannot list: " + error.message());
  std::sort(paths.begin(), paths.end());
  std::map<std::uint64_t, std::string> places;
  for (const std::filesystem::path& path : paths) read_lines(path, places, visit);
}

std::vector<TrialRecord> read_records(const std::string& run_folder) {
  std::vector<TrialRecord> records;
  for_each_record(run_folder, [&](TrialRecord&& record, const RecordLine&) { records.push_back(std::move(record)); });
  std::sort(records.begin(), records.end(),
            [](const TrialRecord& a, const TrialRecord& b) { return a.seed.key < b.seed.key; });
  return records;
}

std::string read_bytes(const std::string& file, std::uint64_t offset, std::size_t count) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(count, '\0');
  if (!stream.seekg(static_cast<std::streamoff>(offset)) ||
      !stream.read(bytes.data(), static_cast<std::streamsize>(count)))
    throw AssetError(file + ": cannot read " + std::to_string(count) + " bytes at " + std::to_string(offset));
  return bytes;
}

}  // namespace binpick

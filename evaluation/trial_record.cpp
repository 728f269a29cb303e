#include "evaluation/trial_record.hpp"

#include "core/hash.hpp"
#include "evaluation/json_archive.hpp"
#include "evaluation/record_fields.hpp"

namespace binpick {
namespace {

std::string hashed_part(const TrialRecord& record) {
  JsonWriter writer;
  record::trial_fields(writer, record);
  return dumped(writer.json);
}

std::uint64_t hash_of(const std::string& canonical) {
  return Hasher().bytes(canonical.data(), canonical.size()).value();
}

}  // namespace

std::uint64_t record_hash(const TrialRecord& record) { return hash_of(hashed_part(record)); }

std::string to_json_line(const TrialRecord& record) {
  std::string line = hashed_part(record);
  const std::string hash = hex(hash_of(line));
  JsonWriter wall;
  record::wall_fields(wall, record);
  line.pop_back();  // the closing brace
  return line + ",\"hash\":\"" + hash + "\",\"wall\":" + dumped(wall.json) + "}";
}

}  // namespace binpick

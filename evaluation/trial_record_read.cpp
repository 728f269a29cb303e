// Reading records back, strictly: a missing, unknown or ill-typed key, another schema or a hash that does not fit the
// values is an error that names file, line and key.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/hash.hpp"
#include "evaluation/record_fields.hpp"
#include "evaluation/trial_record.hpp"

namespace binpick {
namespace {

using Json = nlohmann::json;

class Reader {
 public:
  Reader(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
    if (!json.is_object()) fail("", "is not an object");
  }

  void operator()(const char* key, double& value) {
    const Json& found = at(key);
    if (found.is_null()) {
      value = std::numeric_limits<double>::quiet_NaN();
    } else {
      value = need(found.is_number(), key, "is not a number", found).get<double>();
    }
  }
  void operator()(const char* key, int& value) {
    const Json& found = at(key);
    const bool fits = found.is_number_integer() && found.get<double>() >= std::numeric_limits<int>::min() &&
                      found.get<double>() <= std::numeric_limits<int>::max();
    value = need(fits, key, "is not a whole number", found).get<int>();
  }
  void operator()(const char* key, std::uint64_t& value) {
    const Json& found = at(key);
    value = need(found.is_number_unsigned(), key, "is not a whole number >= 0", found).get<std::uint64_t>();
  }
  void operator()(const char* key, bool& value) {
    const Json& found = at(key);
    value = need(found.is_boolean(), key, "is not true or false", found).get<bool>();
  }
  void operator()(const char* key, std::string& value) {
    const Json& found = at(key);
    value = need(found.is_string(), key, "is not a text", found).get<std::string>();
  }
  template <class T>
  void operator()(const char* key, std::optional<T>& value) {
    value.reset();
    if (at(key).is_null()) return;
    T inner{};
    (*this)(key, inner);
    value = inner;
  }
  void operator()(const char* key, PickOutcome& value) {
    std::string text;
    (*this)(key, text);
    try {
      value = pick_outcome_from(text);
    } catch (const SpecError& error) {
      fail(key, error.what());
    }
  }
  void operator()(const char* key, Eigen::Vector3d& value) {
    const Json& found = need(at(key).is_array() && at(key).size() == 3, key, "is not a list of three numbers", at(key));
    for (std::size_t i = 0; i < 3; ++i) {
      const Json& item = need(found[i].is_number() || found[i].is_null(), key, "holds what is no number", found[i]);
      value[static_cast<Eigen::Index>(i)] =
          item.is_null() ? std::numeric_limits<double>::quiet_NaN() : item.get<double>();
    }
  }
  void operator()(const char* key, std::map<std::string, int>& value) {
    value.clear();
    Reader inner(at(key), place_ + key + ": ");
    for (const auto& entry : at(key).items()) inner(entry.key().c_str(), value[entry.key()]);
  }
  void hash(const char* key, std::uint64_t& value) {
    std::string text;
    (*this)(key, text);
    try {
      value = from_hex(text);
    } catch (const SpecError& error) {
      fail(key, error.what());
    }
  }
  template <class T, class Body>
  void list(const char* key, std::vector<T>& items, const Body& body) {
    const Json& found = need(at(key).is_array(), key, "is not a list", at(key));
    items.resize(found.size());  // `wall` visits the picks that are there already
    for (std::size_t i = 0; i < found.size(); ++i) {
      Reader inner(found[i], place_ + key + "[" + std::to_string(i) + "].");
      body(inner, items[i]);
      inner.finish();
    }
  }

  const Json& at(const char* key) {
    const auto found = json_.find(key);
    if (found == json_.end()) fail(key, "is missing");
    used_.insert(key);
    return *found;
  }
  void finish() const {
    for (const auto& entry : json_.items()) {
      if (!used_.count(entry.key())) fail(entry.key(), "unknown key");
    }
  }
  [[noreturn]] void fail(const std::string& key, const std::string& message) const {
    throw SpecError(place_ + key + ": " + message);
  }

 private:
  const Json& need(bool condition, const char* key, const char* message, const Json& value) const {
    if (!condition) fail(key, message);
    return value;
  }

  const Json& json_;
  std::string place_;
  std::set<std::string> used_;
};

Json parsed(const std::string& line, const std::string& place) {
  try {
    return Json::parse(line);
  } catch (const Json::exception&) {
    throw SpecError(place + ": is not a JSON record");
  }
}

void read_lines(const std::filesystem::path& path, std::vector<TrialRecord>& records,
                std::map<std::uint64_t, std::string>& places) {
  const std::string text = read_file(path.string());
  std::size_t begin = 0, number = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    const std::string place = path.string() + ":" + std::to_string(++number);
    if (end == std::string::npos) {
      throw SpecError(place + ": the last line is incomplete, its writer was cut off; delete that line to go on");
    }
    records.push_back(trial_record_from_json(text.substr(begin, end - begin), place));
    const auto [first, fresh] = places.emplace(records.back().seed.key, place);
    if (!fresh) {
      throw SpecError(place + ": seed " + std::to_string(first->first) + " is recorded already at " + first->second);
    }
    begin = end + 1;
  }
}

}  // namespace

TrialRecord trial_record_from_json(const std::string& line, const std::string& place) {
  const Json json = parsed(line, place);
  TrialRecord record;
  Reader reader(json, place + ": ");
  int schema = 0;
  reader("schema", schema);
  if (schema != kRecordSchema) {
    reader.fail("schema", std::to_string(schema) + " is not " + std::to_string(kRecordSchema) + ", which is read here");
  }
  record::trial_fields(reader, record);
  std::uint64_t hash = 0;
  reader.hash("hash", hash);
  const std::size_t picks = record.picks.size();
  Reader wall(reader.at("wall"), place + ": wall.");
  record::wall_fields(wall, record);
  wall.finish();
  reader.finish();
  if (record.picks.size() != picks) wall.fail("picks", "is not as long as the list of picks");
  if (hash != record_hash(record)) reader.fail("hash", "does not fit the values: the record was altered or damaged");
  return record;
}

std::vector<TrialRecord> read_records(const std::string& run_folder) {
  const std::filesystem::path folder = std::filesystem::path(run_folder) / "records";
  std::error_code error;
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".jsonl") paths.push_back(entry.path());
  }
  if (error) throw AssetError(folder.string() + ": cannot list: " + error.message());
  std::sort(paths.begin(), paths.end());
  std::vector<TrialRecord> records;
  std::map<std::uint64_t, std::string> places;
  for (const std::filesystem::path& path : paths) read_lines(path, records, places);
  std::sort(records.begin(), records.end(),
            [](const TrialRecord& a, const TrialRecord& b) { return a.seed.key < b.seed.key; });
  return records;
}

}  // namespace binpick

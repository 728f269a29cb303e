#include "evaluation/trial_record.hpp"

#include <nlohmann/json.hpp>

#include "core/hash.hpp"
#include "evaluation/record_fields.hpp"

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order of record_fields.hpp

class Writer {
 public:
  Json json = Json::object();

  template <class T>
  void operator()(const char* key, const T& value) {
    json[key] = value;  // a double that is no number is dumped as null
  }
  template <class T>
  void operator()(const char* key, const std::optional<T>& value) {
    json[key] = value ? Json(*value) : Json(nullptr);
  }
  void operator()(const char* key, PickOutcome value) { json[key] = to_string(value); }
  void operator()(const char* key, const Eigen::Vector3d& value) { json[key] = {value.x(), value.y(), value.z()}; }
  void operator()(const char* key, const std::map<std::string, int>& value) {
    Json& object = json[key] = Json::object();
    for (const auto& [name, count] : value) object[name] = count;
  }
  void hash(const char* key, std::uint64_t value) { json[key] = hex(value); }
  template <class T, class Body>
  void list(const char* key, const std::vector<T>& items, const Body& body) {
    Json& array = json[key] = Json::array();
    for (const T& item : items) {
      Writer inner;
      body(inner, item);
      array.push_back(std::move(inner.json));
    }
  }
};

/// Texts may hold bytes of foreign file names: what is not UTF-8 is replaced instead of failing the trial.
std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string hashed_part(const TrialRecord& record) {
  Writer writer;
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
  Writer wall;
  record::wall_fields(wall, record);
  line.pop_back();  // the closing brace
  return line + ",\"hash\":\"" + hash + "\",\"wall\":" + dumped(wall.json) + "}";
}

}  // namespace binpick

// Private to this folder: values to JSON and back, strictly. A missing, unknown or ill-typed key is an error that names
// place and key. Fields are visited as archive("key", value), archive.hash("key", value), archive.list("key", items,
// body), so that one function lists them for writing, hashing and reading.
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "core/one_line.hpp"
#include "core/pick_outcome.hpp"
#include "core/pose.hpp"
#include "evaluation/trial_failure.hpp"

namespace binpick {

using OrderedJson = nlohmann::ordered_json;  // keys stay in the order in which they are visited

class JsonWriter {
 public:
  OrderedJson json = OrderedJson::object();

  template <class T>
  void operator()(const char* key, const T& value) {
    json[key] = value;  // a double that is no number is dumped as null
  }
  template <class T>
  void operator()(const char* key, const std::optional<T>& value) {
    json[key] = nullptr;
    if (value) (*this)(key, *value);
  }
  /// No key when there is no value.
  template <class T>
  void if_any(const char* key, const std::optional<T>& value) {
    if (value) (*this)(key, *value);
  }
  /// No key for the usual value.
  template <class T>
  void unless(const char* key, const T& value, const T& usual) {
    if (value != usual) (*this)(key, value);
  }
  void operator()(const char* key, PickOutcome value) { json[key] = to_string(value); }
  void operator()(const char* key, TrialFailure value) { json[key] = to_string(value); }
  void operator()(const char* key, const Eigen::Vector3d& value) { json[key] = {value.x(), value.y(), value.z()}; }
  void operator()(const char* key, const std::map<std::string, int>& value) {
    OrderedJson& object = json[key] = OrderedJson::object();
    for (const auto& [name, count] : value) object[name] = count;
  }
  void hash(const char* key, std::uint64_t value) { json[key] = hex(value); }
  /// One member of every item, as a list.
  template <class T, class Value>
  void column(const char* key, const std::vector<T>& items, Value T::*member) {
    OrderedJson& array = json[key] = OrderedJson::array();
    for (const T& item : items) array.push_back(item.*member);
  }
  template <class T, class Body>
  void list(const char* key, const std::vector<T>& items, const Body& body) {
    OrderedJson& array = json[key] = OrderedJson::array();
    for (const T& item : items) {
      JsonWriter inner;
      body(inner, item);
      array.push_back(std::move(inner.json));
    }
  }
};

/// Texts may hold bytes of foreign file names: what is not UTF-8 is replaced instead of failing the trial.
inline std::string dumped(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

class JsonReader {
 public:
  JsonReader(const nlohmann::json& json, std::string place) : json_(json), place_(std::move(place)) {
    if (!json.is_object()) fail("", "is not an object");
  }

  void operator()(const char* key, double& value) {
    const nlohmann::json& found = at(key);
    if (found.is_null()) {
      value = std::numeric_limits<double>::quiet_NaN();
    } else {
      value = need(found.is_number(), key, "is not a number", found).get<double>();
    }
  }
  void operator()(const char* key, int& value) {
    const nlohmann::json& found = at(key);
    const bool fits = found.is_number_integer() && found.get<double>() >= std::numeric_limits<int>::min() &&
                      found.get<double>() <= std::numeric_limits<int>::max();
    value = need(fits, key, "is not a whole number", found).get<int>();
  }
  void operator()(const char* key, std::uint64_t& value) {
    const nlohmann::json& found = at(key);
    value = need(found.is_number_unsigned(), key, "is not a whole number >= 0", found).get<std::uint64_t>();
  }
  void operator()(const char* key, bool& value) {
    const nlohmann::json& found = at(key);
    value = need(found.is_boolean(), key, "is not true or false", found).get<bool>();
  }
  void operator()(const char* key, std::string& value) {
    const nlohmann::json& found = at(key);
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
  template <class T>
  void if_any(const char* key, std::optional<T>& value) {
    value.reset();
    if (json_.contains(key)) (*this)(key, value.emplace());
  }
  template <class T>
  void unless(const char* key, T& value, const T& usual) {
    value = usual;
    if (json_.contains(key)) (*this)(key, value);
  }
  void operator()(const char* key, PickOutcome& value) { named(key, value, pick_outcome_from); }
  void operator()(const char* key, TrialFailure& value) { named(key, value, trial_failure_from); }
  void operator()(const char* key, Eigen::Vector3d& value) {
    const nlohmann::json& found =
        need(at(key).is_array() && at(key).size() == 3, key, "is not a list of three numbers", at(key));
    for (std::size_t i = 0; i < 3; ++i) {
      const nlohmann::json& item =
          need(found[i].is_number() || found[i].is_null(), key, "holds what is no number", found[i]);
      value[static_cast<Eigen::Index>(i)] =
          item.is_null() ? std::numeric_limits<double>::quiet_NaN() : item.get<double>();
    }
  }
  void operator()(const char* key, std::map<std::string, int>& value) {
    value.clear();
    JsonReader inner(at(key), place_ + key + ": ");
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
  void operator()(const char* key, std::vector<double>& values) {
    const nlohmann::json& found = need(at(key).is_array(), key, "is not a list", at(key));
    values.clear();
    for (const nlohmann::json& item : found)
      values.push_back(need(item.is_number(), key, "holds what is no number", item));
  }
  /// The first column says how many items there are.
  template <class T, class Value>
  void column(const char* key, std::vector<T>& items, Value T::*member) {
    std::vector<double> values;
    (*this)(key, values);
    if (items.empty()) items.resize(values.size());
    if (values.size() != items.size()) fail(key, "is not as long as the columns before it");
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::abs(values[i]) > 1e6) fail(key, "holds a number out of all range");
      items[i].*member = static_cast<Value>(values[i]);
    }
  }
  template <class T, class Body>
  void list(const char* key, std::vector<T>& items, const Body& body) {
    const nlohmann::json& found = need(at(key).is_array(), key, "is not a list", at(key));
    items.resize(found.size());  // `wall` visits the picks that are there already
    for (std::size_t i = 0; i < found.size(); ++i) {
      JsonReader inner(found[i], place_ + key + "[" + std::to_string(i) + "].");
      body(inner, items[i]);
      inner.finish();
    }
  }

  const nlohmann::json& at(const char* key) {
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
    throw SpecError(one_line(place_ + key + ": " + message));
  }

 private:
  template <class T>
  void named(const char* key, T& value, T (*from)(const std::string&)) {
    std::string text;
    (*this)(key, text);
    try {
      value = from(text);
    } catch (const SpecError& error) {
      fail(key, error.what());
    }
  }
  const nlohmann::json& need(bool condition, const char* key, const char* message, const nlohmann::json& value) const {
    if (!condition) fail(key, message);
    return value;
  }

  const nlohmann::json& json_;
  std::string place_;
  std::set<std::string> used_;
};

/// One line of a file of JSON lines; SpecError at `place`.
inline nlohmann::json parsed_line(const std::string& line, const std::string& place) {
  try {
    return nlohmann::json::parse(line);
  } catch (const nlohmann::json::exception&) {
    throw SpecError(place + ": is not a JSON record");
  }
}

}  // namespace binpick

// Private to this folder: other people's JSON, read by its place in the file. Unknown keys are theirs; what is missing
// or no number is an AssetError that names file and place.
#pragma once

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/one_line.hpp"
#include "core/pose.hpp"

namespace binpick {

class JsonPlace {
 public:
  JsonPlace(const nlohmann::json& value, std::string place) : value_(value), place_(std::move(place)) {}

  const nlohmann::json& value() const { return value_; }
  const std::string& place() const { return place_; }
  bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }

  JsonPlace at(const std::string& key) const {
    if (!value_.is_object()) fail("is not an object");
    if (!value_.contains(key)) fail("has no '" + key + "'");
    return {value_.at(key), place_ + " " + key};
  }
  JsonPlace at(std::size_t index) const { return {value_.at(index), place_ + "[" + std::to_string(index) + "]"}; }
  std::size_t size() const {
    if (!value_.is_array()) fail("is not a list");
    return value_.size();
  }
  double number() const {
    if (!value_.is_number()) fail("is not a number");
    const double number = value_.get<double>();
    if (!std::isfinite(number)) fail("is not a finite number");
    return number;
  }
  int integer() const {
    if (!value_.is_number_integer() && !(value_.is_number() && value_.get<double>() == std::floor(number())))
      fail("is not a whole number");
    const double number = value_.get<double>();
    if (!(std::abs(number) < std::numeric_limits<int>::max())) fail("is out of range");
    return static_cast<int>(number);
  }
  std::vector<double> numbers(std::size_t count) const {
    if (size() != count) fail("holds " + std::to_string(size()) + " numbers, not " + std::to_string(count));
    std::vector<double> numbers;
    for (std::size_t i = 0; i < count; ++i) numbers.push_back(at(i).number());
    return numbers;
  }
  Eigen::Vector3d vector() const {
    const std::vector<double> v = numbers(3);
    return {v[0], v[1], v[2]};
  }
  [[noreturn]] void fail(const std::string& message) const { throw AssetError(one_line(place_ + ": " + message)); }

 private:
  const nlohmann::json& value_;
  std::string place_;
};

inline nlohmann::json read_json(const std::string& path) {
  const std::string text = read_file(path);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    throw AssetError(path + ": is not JSON: byte " + std::to_string(error.byte));
  }
}

/// A pose from a rotation that was printed with a few digits, made orthonormal, and a translation in metres. Nothing
/// when it is no rotation.
inline std::optional<Pose> pose_of_file(const std::vector<double>& rotation, const Eigen::Vector3d& translation) {
  constexpr double kRounded = 0.01, kExact = 1e-12;
  Pose X = Pose::Identity();
  for (int i = 0; i < 9; ++i) X.linear()(i / 3, i % 3) = rotation[static_cast<std::size_t>(i)];
  X.translation() = translation;
  if (!is_rigid(X, kRounded)) return std::nullopt;
  return is_rigid(X, kExact) ? X : orthonormalised(X);
}

}  // namespace binpick

// One visitor per configuration struct gives strict YAML reading, YAML writing and the documentation table.
//
//   struct DropConfig {
//     double height = 0.4;                                       // m above the bin floor
//     void visit(ConfigVisitor& v) { v.field("height", height, Unit::kLength, "release height above the bin floor"); }
//     void validate() const;                                     // throws SpecError
//   };
//
// A bare YAML number is SI; `5 mm`, `12 deg`, `250 ms` are converted at the reader (quantity.hpp).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/pose.hpp"

namespace binpick {

enum class Unit {
  kNone,
  kLength,
  kAngle,
  kTime,
  kMass,
  kDensity,
  kSpeed,
  kAngularSpeed,
  kAcceleration,
  kPressure,
  kForce,
  kStiffness
};

/// Does an item of a command name a file? See ConfigVisitor::command.
inline bool is_path_item(const std::string& item) {
  return item.rfind("/", 0) == 0 || item.rfind("./", 0) == 0 || item.rfind("../", 0) == 0;
}

class ConfigVisitor {
 public:
  virtual ~ConfigVisitor() = default;

  /// True while values are being read from the user's file, so that `preset:` may load values that later keys override.
  virtual bool reading() const = 0;

  virtual void field(const char* key, double& value, Unit unit, const char* help) = 0;
  virtual void field(const char* key, int& value, const char* help) = 0;
  virtual void field(const char* key, bool& value, const char* help) = 0;
  virtual void field(const char* key, std::string& value, const char* help) = 0;
  virtual void field(const char* key, Eigen::Vector3d& value, Unit unit, const char* help) = 0;
  virtual void field(const char* key, std::vector<double>& value, Unit unit, const char* help) = 0;
  /// A pose: {xyz: [..], rpy: [..]}; either part may be left out.
  virtual void field(const char* key, Pose& value, const char* help) = 0;
  /// One of a closed list; anything else is an error that names the nearest.
  virtual void choice(const char* key, std::string& value, const std::vector<std::string>& allowed,
                      const char* help) = 0;
  /// A path: read relative to the file that holds it (becoming absolute), written relative to the file that is written.
  virtual void path(const char* key, std::string& value, const char* help) = 0;
  /// A program and its arguments, a list of texts. Items that begin with `./`, `../` or `/` are paths, as above; a
  /// program named without a slash is looked for where the shell would.
  virtual void command(const char* key, std::vector<std::string>& value, const char* help) = 0;

  /// A nested mapping.
  template <class Config>
  void section(const char* key, Config& config, const char* help) {
    section_with(
        key, [&](ConfigVisitor& v) { config.visit(v); }, help);
  }
  virtual void section_with(const char* key, const std::function<void(ConfigVisitor&)>& body, const char* help) = 0;

  /// A list of mappings: while reading, resize(n) is called first.
  template <class Config>
  void list(const char* key, std::vector<Config>& items, const char* help) {
    list_with(
        key, items.size(), [&](std::size_t n) { items.resize(n); },
        [&](std::size_t i, ConfigVisitor& v) { items[i].visit(v); }, help);
  }
  virtual void list_with(const char* key, std::size_t size, const std::function<void(std::size_t)>& resize,
                         const std::function<void(std::size_t, ConfigVisitor&)>& body, const char* help) = 0;

  /// While reading: does the current mapping hold this key? Otherwise false.
  virtual bool has(const char* key) const = 0;
  /// While reading: is the value of this key a plain scalar, as in `part: path` instead of `part: {mesh: ..}`?
  virtual bool is_scalar(const char* key) const = 0;
  /// While reading: throws SpecError with file, line and the key; otherwise does nothing.
  virtual void fail(const char* key, const std::string& message) const = 0;
};

}  // namespace binpick

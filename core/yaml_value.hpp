// A value of a YAML file in whatever shape, with its place: for files that hold pieces of other files, as a sweep holds
// values of a scene's fields. And such values set over a file before it is read.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/config.hpp"

namespace binpick {

class YamlValue {
 public:
  /// The mapping that a file holds, under the rules of yaml.hpp. Throws SpecError.
  static YamlValue from_file(const std::string& path);
  /// The same from text; `name` stands for the file in messages, paths are relative to `folder`.
  static YamlValue from_text(const std::string& text, const std::string& name, const std::string& folder);

  bool is_scalar() const;
  bool is_list() const;
  bool is_mapping() const;
  std::string scalar() const;            ///< throws SpecError where it is none
  std::vector<YamlValue> items() const;  ///< of a list; throws SpecError where it is none
  /// Of a mapping, as they stand in the file; throws SpecError where it is none.
  std::vector<std::pair<YamlValue, YamlValue>> entries() const;
  std::string text() const;  ///< on one line

  /// Reads this mapping as a configuration; the keys `beside` are left to the caller.
  void visit(const std::function<void(ConfigVisitor&)>& body, const std::vector<std::string>& beside = {}) const;
  /// A scalar of this text, at the place of this value.
  YamlValue with_text(const std::string& text) const;
  std::string place() const;                                 ///< "sweep.yaml:7"
  [[noreturn]] void fail(const std::string& message) const;  ///< throws SpecError: "sweep.yaml:7: message"

 private:
  friend class YamlOverlay;
  struct Data;
  explicit YamlValue(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

/// One field of a file, and what it is to be. The field is a path of keys: `drop.height`, `parts[1].count`; an index
/// names an item of a list that is there. Where the path goes on below a file's name (`cell: mz07.yaml` and
/// `cell.look.camera.xyz[2]`), what that file holds takes the name's place.
struct YamlSetting {
  std::string field;
  YamlValue value;
};

/// read_yaml_file (yaml.hpp) as if the file had said so. A message names the file and the line of what it is about.
void read_yaml_file(const std::string& path, std::span<const YamlSetting> settings,
                    const std::function<void(ConfigVisitor&)>& body);

}  // namespace binpick

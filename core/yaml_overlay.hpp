// Private to core: values set over a YAML document, and the files that had to be opened to set them.
#pragma once

#include <yaml-cpp/yaml.h>

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/yaml_reader.hpp"
#include "core/yaml_value.hpp"

namespace binpick {

struct YamlValue::Data {
  YAML::Node node;
  YamlSource source;  ///< of a value without a line of its own the name has the line
};

struct PlacedNode {
  YAML::Node node;
  YamlSource source;
};

class YamlOverlay {
 public:
  /// Throws SpecError: a path that leads nowhere.
  YamlOverlay(const YAML::Node& root, const YamlSource& source, std::vector<YamlSetting> settings);

  /// What stands at this dotted path instead of the document's own value; null: nothing.
  const PlacedNode* find(const std::string& path) const;
  /// Keys that were set in the mapping at this path; items of lists are none.
  std::vector<std::string> keys_in(const std::string& path) const;
  /// Does the message begin with the name of one of the files?
  bool names_a_file(const std::string& message) const;

 private:
  struct Step {
    std::string key;
    std::optional<std::size_t> item;
  };
  using Steps = std::span<const Step>;

  static std::vector<Step> steps_of(const YamlSetting& setting);
  void set(const PlacedNode& mapping, const std::string& path, Steps steps, const YamlSetting& setting);
  void set_in_list(const std::optional<PlacedNode>& list, const std::string& path, Steps steps,
                   const YamlSetting& setting);
  std::optional<PlacedNode> child(const PlacedNode& mapping, const std::string& path, const std::string& key);
  const PlacedNode& put(const std::string& path, const YAML::Node& node, const YamlSource& source);
  const PlacedNode& opened(const std::string& path, const PlacedNode& name, const YamlSetting& setting);

  std::map<std::string, PlacedNode> nodes_;
  std::vector<std::string> files_;
};

}  // namespace binpick

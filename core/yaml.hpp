// Strict YAML. Unknown, repeated or misspelt keys are errors with file, line and the nearest valid name; anchors and
// aliases are refused (they can explode), files over 1 MiB too.
#pragma once

#include <functional>
#include <string>

#include "core/config.hpp"

namespace binpick {

/// Reads a file and visits `body` with it. Throws SpecError: "scene.yaml:14: drop.cont: unknown key, did you mean ..".
void read_yaml_file(const std::string& path, const std::function<void(ConfigVisitor&)>& body);
/// The same from text; `name` stands for the file in messages, paths are relative to `folder`.
void read_yaml_text(const std::string& text, const std::string& name, const std::string& folder,
                    const std::function<void(ConfigVisitor&)>& body);
/// Every value, defaults included; paths are written relative to `folder` (empty: as they are).
std::string write_yaml(const std::function<void(ConfigVisitor&)>& body, const std::string& folder = "");
/// What stands for a file that an item of a command names, where its place must not matter.
using FileNaming = std::function<std::string(const std::string& path)>;
std::string write_yaml(const std::function<void(ConfigVisitor&)>& body, const FileNaming& naming);
/// A Markdown table of key, default, unit and meaning.
std::string describe_config(const std::function<void(ConfigVisitor&)>& body);

template <class Config>
Config read_config_file(const std::string& path) {
  Config config;
  read_yaml_file(path, [&](ConfigVisitor& v) { config.visit(v); });
  return config;
}

/// The candidate with the smallest edit distance, or "" when none is near.
std::string nearest_name(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace binpick

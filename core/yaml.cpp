#include "core/yaml.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/one_line.hpp"
#include "core/yaml_reader.hpp"
#include "core/yaml_writer.hpp"

namespace binpick {
namespace {

// Levenshtein distance, one row at a time.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j < row.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replace}));
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(const std::string& name, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 2) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = candidate;
  }
  if (!best.empty() || name.size() < 3) return best;
  // The beginning of a longer name, as d435 is of d435_848.
  for (const std::string& candidate : candidates)
    if (edit_distance(name, candidate.substr(0, name.size())) <= name.size() / 4) return candidate;
  return best;
}

void read_yaml_text(const std::string& text, const std::string& name, const std::string& folder,
                    const std::function<void(ConfigVisitor&)>& body) {
  const YamlSource source{name, folder};
  try {
    const YAML::Node root = parse_strictly(text, source);
    YamlReader reader(root, source, "");
    body(reader);
    reader.check_all_used();
  } catch (const SpecError& error) {
    // Errors of validate() know the key but not the file.
    const std::string message = one_line(error.what());
    throw SpecError(message.rfind(name, 0) == 0 ? message : name + ": " + message);
  }
}

void read_yaml_file(const std::string& path, const std::function<void(ConfigVisitor&)>& body) {
  std::string text;
  try {
    text = read_file(path, std::size_t{1} << 20);
  } catch (const AssetError& error) {
    throw SpecError(error.what());
  }
  std::error_code ignored;
  const std::filesystem::path absolute = std::filesystem::absolute(path, ignored).lexically_normal();
  read_yaml_text(text, path, absolute.parent_path().string(), body);
}

std::string write_yaml(const std::function<void(ConfigVisitor&)>& body, const std::string& folder) {
  YamlWriter writer(folder);
  body(writer);
  return writer.text();
}

std::string write_yaml(const std::function<void(ConfigVisitor&)>& body, const FileNaming& naming) {
  YamlWriter writer("", naming);
  body(writer);
  return writer.text();
}

std::string describe_config(const std::function<void(ConfigVisitor&)>& body) {
  ConfigDescriber describer;
  body(describer);
  return describer.text();
}

}  // namespace binpick

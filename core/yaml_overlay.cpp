#include "core/yaml_overlay.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"

namespace binpick {
namespace {

std::string dotted(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

std::string shown(const PlacedNode& placed) {
  return "'" + placed.node.Scalar() + "' (" + placed.source.name +
         (placed.node.Mark().is_null() ? "" : ":" + std::to_string(placed.node.Mark().line + 1)) + ")";
}

}  // namespace

YamlOverlay::YamlOverlay(const YAML::Node& root, const YamlSource& source, std::vector<YamlSetting> settings) {
  files_.push_back(source.name);
  // What is set inside a value finds that value in its place, whichever was named first.
  std::stable_sort(settings.begin(), settings.end(), [](const YamlSetting& a, const YamlSetting& b) {
    return std::count(a.field.begin(), a.field.end(), '.') < std::count(b.field.begin(), b.field.end(), '.');
  });
  for (const YamlSetting& setting : settings) {
    files_.push_back(setting.value.data_->source.name);
    const std::vector<Step> steps = steps_of(setting);
    set({root, source}, "", steps, setting);
  }
}

std::vector<YamlOverlay::Step> YamlOverlay::steps_of(const YamlSetting& setting) {
  std::vector<Step> steps;
  const std::string& field = setting.field;
  for (std::size_t begin = 0; begin <= field.size();) {
    const std::size_t end = std::min(field.find('.', begin), field.size());
    Step step{field.substr(begin, end - begin), std::nullopt};
    const std::size_t bracket = step.key.find('[');
    bool right = !step.key.empty() && bracket != 0;
    if (right && bracket != std::string::npos) {
      std::size_t item = 0;
      const char *first = step.key.data() + bracket + 1, *last = step.key.data() + step.key.size() - 1;
      const auto [stop, error] = std::from_chars(first, last, item);
      right = step.key.back() == ']' && first < last && error == std::errc() && stop == last;
      step.key.resize(bracket);
      step.item = item;
    }
    if (!right)
      setting.value.fail("'" + field + "' is not the path of a field, like drop.height or cell.gripper.cups[0].radius");
    steps.push_back(step);
    begin = end + 1;
  }
  return steps;
}

const PlacedNode* YamlOverlay::find(const std::string& path) const {
  const auto place = nodes_.find(path);
  return place == nodes_.end() ? nullptr : &place->second;
}

std::vector<std::string> YamlOverlay::keys_in(const std::string& path) const {
  std::vector<std::string> keys;
  const std::string prefix = path.empty() ? "" : path + ".";
  for (const auto& [full, unused] : nodes_)
    if (full.rfind(prefix, 0) == 0 && full.find('.', prefix.size()) == std::string::npos && full.back() != ']')
      keys.push_back(full.substr(prefix.size()));
  return keys;
}

bool YamlOverlay::names_a_file(const std::string& message) const {
  return std::any_of(files_.begin(), files_.end(),
                     [&](const std::string& name) { return message.rfind(name, 0) == 0; });
}

// Assigning a node changes what it stands for: nodes are only ever built in place.
const PlacedNode& YamlOverlay::put(const std::string& path, const YAML::Node& node, const YamlSource& source) {
  for (auto place = nodes_.lower_bound(path); place != nodes_.end() && place->first.rfind(path, 0) == 0;) {
    const char next = place->first.size() == path.size() ? '.' : place->first[path.size()];
    place = next == '.' || next == '[' ? nodes_.erase(place) : std::next(place);
  }
  return nodes_.emplace(path, PlacedNode{node, source}).first->second;
}

/// The mapping of the file that stands where the path goes on.
const PlacedNode& YamlOverlay::opened(const std::string& path, const PlacedNode& name, const YamlSetting& setting) {
  const std::filesystem::path file = name.node.Scalar();
  const std::string full =
      (file.is_absolute() ? file : std::filesystem::path(name.source.folder) / file).lexically_normal().string();
  if (!std::filesystem::is_regular_file(full))
    setting.value.fail(setting.field + ": " + path + " is " + shown(name) + ", neither a mapping nor a file");
  files_.push_back(full);
  const YamlSource source{full, std::filesystem::path(full).parent_path().string()};
  return put(path, parse_strictly(read_file(full, std::size_t{1} << 20), source), source);
}

std::optional<PlacedNode> YamlOverlay::child(const PlacedNode& mapping, const std::string& path,
                                             const std::string& key) {
  if (const PlacedNode* set = find(dotted(path, key))) return *set;
  const YAML::Node& node = mapping.node;  // const: operator[] must not create the key
  if (node[key]) return PlacedNode{node[key], mapping.source};
  if (key == "base") return std::nullopt;
  // `base:` names a file that the mapping starts from.
  const std::optional<PlacedNode> base = child(mapping, path, "base");
  if (!base || !base->node.IsScalar()) return std::nullopt;
  const std::filesystem::path file = std::filesystem::path(base->source.folder) / base->node.Scalar();
  if (!std::filesystem::is_regular_file(file)) return std::nullopt;  // its reader says so
  const YamlSource source{file.lexically_normal().string(), file.lexically_normal().parent_path().string()};
  files_.push_back(source.name);
  const YAML::Node start = parse_strictly(read_file(source.name, std::size_t{1} << 20), source);
  if (!start[key]) return std::nullopt;
  return put(dotted(path, key), start[key], source);
}

void YamlOverlay::set(const PlacedNode& mapping, const std::string& path, Steps steps, const YamlSetting& setting) {
  const std::string here = dotted(path, steps.front().key);
  const YamlValue::Data& value = *setting.value.data_;
  if (steps.size() == 1 && !steps.front().item) {
    put(here, value.node, value.source);
    return;
  }
  const std::optional<PlacedNode> below = child(mapping, path, steps.front().key);
  if (steps.front().item) return set_in_list(below, here, steps, setting);
  if (!below)
    return set(put(here, YAML::Node(YAML::NodeType::Map), {setting.value.place(), ""}), here, steps.subspan(1),
               setting);
  if (below->node.IsScalar()) return set(opened(here, *below, setting), here, steps.subspan(1), setting);
  if (!below->node.IsMap()) setting.value.fail(setting.field + ": " + here + " is not a mapping");
  set(*below, here, steps.subspan(1), setting);
}

void YamlOverlay::set_in_list(const std::optional<PlacedNode>& list, const std::string& path, Steps steps,
                              const YamlSetting& setting) {
  const std::size_t item = *steps.front().item;
  if (!list || !list->node.IsSequence())
    setting.value.fail(setting.field + ": there is no list " + path + " to set an item of; set all of it");
  if (item >= list->node.size())
    setting.value.fail(setting.field + ": " + path + " has " + std::to_string(list->node.size()) +
                       " items, counted from 0");
  const std::string here = path + "[" + std::to_string(item) + "]";
  const YamlValue::Data& value = *setting.value.data_;
  if (steps.size() == 1) {
    put(here, value.node, value.source);
    return;
  }
  const PlacedNode* placed = find(here);
  const PlacedNode mapping = placed ? *placed : PlacedNode{list->node[item], list->source};
  if (!mapping.node.IsMap()) setting.value.fail(setting.field + ": " + here + " is not a mapping");
  set(mapping, here, steps.subspan(1), setting);
}

}  // namespace binpick

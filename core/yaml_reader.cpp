#include "core/yaml_reader.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "core/error.hpp"
#include "core/one_line.hpp"
#include "core/quantity.hpp"
#include "core/yaml.hpp"
#include "core/yaml_overlay.hpp"

namespace binpick {

YamlReader::YamlReader(const YAML::Node& node, const YamlSource& source, std::string prefix, const YamlOverlay* overlay)
    : node_(node), source_(source), prefix_(std::move(prefix)), overlay_(overlay) {}

std::string YamlReader::dotted(const std::string& key) const { return prefix_.empty() ? key : prefix_ + "." + key; }

void YamlReader::fail_at(const Found& found, const std::string& key, const std::string& message) const {
  throw SpecError(place(*found.source, found.node.Mark()) + ": " + dotted(key) + ": " + message);
}

YamlReader::Found YamlReader::find(const char* key) const {
  if (overlay_)
    if (const PlacedNode* set = overlay_->find(dotted(key))) return {set->node, &set->source};
  return {node_[key], &source_};
}

YamlReader::Found YamlReader::take(const char* key) {
  asked_.insert(key);
  return find(key);
}

YamlReader::Found YamlReader::item(const Found& list, const std::string& key, std::size_t index) const {
  if (overlay_)
    if (const PlacedNode* set = overlay_->find(dotted(key) + "[" + std::to_string(index) + "]"))
      return {set->node, &set->source};
  return {list.node[index], list.source};
}

std::string YamlReader::scalar(const Found& found, const std::string& key) const {
  if (!found.node.IsScalar()) fail_at(found, key, "must be a single value");
  // A path would end at a zero byte, a name would break the line of every message and table that shows it.
  const std::string& text = found.node.Scalar();
  if (std::any_of(text.begin(), text.end(), is_control)) fail_at(found, key, "holds a control character");
  return text;
}

double YamlReader::number(const Found& found, const std::string& key, Unit unit) const {
  const std::string text = scalar(found, key);
  try {
    return parse_quantity(text, unit);
  } catch (const SpecError& error) {
    fail_at(found, key, error.what());
  }
}

std::vector<double> YamlReader::numbers(const Found& found, const std::string& key, Unit unit) const {
  if (!found.node.IsSequence()) fail_at(found, key, "must be a list of numbers, like [0.4, 0.3, 0.2]");
  std::vector<double> values;
  for (std::size_t i = 0; i < found.node.size(); ++i) values.push_back(number(item(found, key, i), key, unit));
  return values;
}

void YamlReader::field(const char* key, double& value, Unit unit, const char*) {
  if (const Found found = take(key)) value = number(found, key, unit);
}

void YamlReader::field(const char* key, int& value, const char*) {
  const Found found = take(key);
  if (!found) return;
  const std::string text = scalar(found, key);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    fail_at(found, key, "'" + text + "' is not a whole number");
}

void YamlReader::field(const char* key, bool& value, const char*) {
  const Found found = take(key);
  if (!found) return;
  const std::string text = scalar(found, key);
  if (text != "true" && text != "false") fail_at(found, key, "must be true or false");
  value = text == "true";
}

void YamlReader::field(const char* key, std::string& value, const char*) {
  if (const Found found = take(key)) value = scalar(found, key);
}

void YamlReader::field(const char* key, Eigen::Vector3d& value, Unit unit, const char*) {
  const Found found = take(key);
  if (!found) return;
  const std::vector<double> read = numbers(found, key, unit);
  if (read.size() != 3) fail_at(found, key, "needs three numbers, has " + std::to_string(read.size()));
  value = Eigen::Vector3d(read[0], read[1], read[2]);
}

void YamlReader::field(const char* key, std::vector<double>& value, Unit unit, const char*) {
  if (const Found found = take(key)) value = numbers(found, key, unit);
}

void YamlReader::field(const char* key, Pose& value, const char* help) {
  Eigen::Vector3d xyz = value.translation(), rpy = rpy_of(value.linear());
  section_with(
      key,
      [&](ConfigVisitor& v) {
        v.field("xyz", xyz, Unit::kLength, "position");
        v.field("rpy", rpy, Unit::kAngle, "roll, pitch, yaw");
      },
      help);
  value = stored_pose(pose_from_xyz_rpy(xyz, rpy));
}

void YamlReader::choice(const char* key, std::string& value, const std::vector<std::string>& allowed, const char*) {
  const Found found = take(key);
  if (!found) return;
  const std::string text = scalar(found, key);
  if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
    std::string all;
    for (const std::string& name : allowed) all += (all.empty() ? "" : ", ") + name;
    const std::string near = nearest_name(text, allowed);
    fail_at(found, key,
            "'" + text + "' is not known" + (near.empty() ? "" : ", did you mean " + near + "?") + " (one of: " + all +
                ")");
  }
  value = text;
}

void YamlReader::path(const char* key, std::string& value, const char*) {
  const Found found = take(key);
  if (!found) return;
  const std::filesystem::path read = scalar(found, key);
  if (read.empty()) fail_at(found, key, "is empty");
  value = found.from_here(read);
}

std::string YamlReader::Found::from_here(const std::filesystem::path& read) const {
  return (read.is_absolute() ? read : std::filesystem::path(source->folder) / read).lexically_normal().string();
}

void YamlReader::command(const char* key, std::vector<std::string>& value, const char*) {
  const Found found = take(key);
  if (!found) return;
  if (!found.node.IsSequence()) fail_at(found, key, "must be a list: [program, argument, ..]");
  value.clear();
  for (std::size_t i = 0; i < found.node.size(); ++i) {
    const Found one = item(found, key, i);
    const std::string text = scalar(one, key);
    value.push_back(is_path_item(text) ? one.from_here(text) : text);
  }
}

void YamlReader::section_with(const char* key, const std::function<void(ConfigVisitor&)>& body, const char*) {
  const Found found = take(key);
  if (!found) return;
  if (!found.node.IsMap()) fail_at(found, key, "must be a mapping of `key: value`");
  YamlReader nested(found.node, *found.source, dotted(key), overlay_);
  body(nested);
  nested.check_all_used();
}

void YamlReader::list_with(const char* key, std::size_t, const std::function<void(std::size_t)>& resize,
                           const std::function<void(std::size_t, ConfigVisitor&)>& body, const char*) {
  const Found found = take(key);
  if (!found) return;
  if (!found.node.IsSequence()) fail_at(found, key, "must be a list");
  resize(found.node.size());
  for (std::size_t i = 0; i < found.node.size(); ++i) {
    const std::string name = dotted(key) + "[" + std::to_string(i) + "]";
    const Found one = item(found, key, i);
    if (!one.node.IsMap()) fail_at(one, key, "every item must be a mapping of `key: value`");
    YamlReader nested(one.node, *one.source, name, overlay_);
    body(i, nested);
    nested.check_all_used();
  }
}

bool YamlReader::has(const char* key) const { return static_cast<bool>(find(key)); }

bool YamlReader::is_scalar(const char* key) const {
  const Found found = find(key);
  return found && found.node.IsScalar();
}

void YamlReader::fail(const char* key, const std::string& message) const {
  const Found found = find(key);
  fail_at(found ? found : Found{node_, &source_}, key, message);
}

void YamlReader::fail_unknown(const Found& found, const std::string& key) const {
  const std::string near = nearest_name(key, {asked_.begin(), asked_.end()});
  fail_at(found, key, "unknown key" + (near.empty() ? "" : ", did you mean " + dotted(near) + "?"));
}

void YamlReader::check_all_used() const {
  for (const auto& entry : node_)
    if (!asked_.count(entry.first.Scalar())) fail_unknown({entry.first, &source_}, entry.first.Scalar());
  if (!overlay_) return;
  for (const std::string& key : overlay_->keys_in(prefix_))
    if (!asked_.count(key)) fail_unknown(find(key.c_str()), key);
}

}  // namespace binpick

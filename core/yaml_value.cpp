#include "core/yaml_value.hpp"

#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/one_line.hpp"
#include "core/yaml_overlay.hpp"

namespace binpick {
namespace {

constexpr std::size_t kLimit = std::size_t{1} << 20;

std::string text_of_file(const std::string& path) {
  try {
    return read_file(path, kLimit);
  } catch (const AssetError& error) {
    throw SpecError(error.what());
  }
}

std::string folder_of(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::absolute(path, ignored).lexically_normal().parent_path().string();
}

}  // namespace

YamlValue YamlValue::from_text(const std::string& text, const std::string& name, const std::string& folder) {
  const YamlSource source{name, folder};
  return YamlValue(std::make_shared<const Data>(Data{parse_strictly(text, source), source}));
}

YamlValue YamlValue::from_file(const std::string& path) { return from_text(text_of_file(path), path, folder_of(path)); }

bool YamlValue::is_scalar() const { return data_->node.IsScalar(); }
bool YamlValue::is_list() const { return data_->node.IsSequence(); }
bool YamlValue::is_mapping() const { return data_->node.IsMap(); }

std::string YamlValue::scalar() const {
  if (!is_scalar()) fail("must be a single value");
  return one_line(data_->node.Scalar());
}

std::vector<YamlValue> YamlValue::items() const {
  if (!is_list()) fail("must be a list");
  std::vector<YamlValue> all;
  for (const auto& item : data_->node)
    all.push_back(YamlValue(std::make_shared<const Data>(Data{item, data_->source})));
  return all;
}

std::vector<std::pair<YamlValue, YamlValue>> YamlValue::entries() const {
  if (!is_mapping()) fail("must be a mapping of `key: value`");
  std::vector<std::pair<YamlValue, YamlValue>> all;
  for (const auto& entry : data_->node)
    all.emplace_back(YamlValue(std::make_shared<const Data>(Data{entry.first, data_->source})),
                     YamlValue(std::make_shared<const Data>(Data{entry.second, data_->source})));
  return all;
}

std::string YamlValue::text() const {
  if (is_scalar()) return scalar();
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << data_->node;
  return one_line(out.c_str());
}

void YamlValue::visit(const std::function<void(ConfigVisitor&)>& body, const std::vector<std::string>& beside) const {
  if (!is_mapping()) fail("must be a mapping of `key: value`");
  YamlReader reader(data_->node, data_->source, "");
  for (const std::string& key : beside) reader.leave(key);
  body(reader);
  reader.check_all_used();
}

YamlValue YamlValue::with_text(const std::string& text) const {
  return YamlValue(std::make_shared<const Data>(Data{YAML::Node(text), YamlSource{place(), data_->source.folder}}));
}

std::string YamlValue::place() const {
  const YAML::Mark mark = data_->node.Mark();
  return mark.is_null() ? data_->source.name : data_->source.name + ":" + std::to_string(mark.line + 1);
}

void YamlValue::fail(const std::string& message) const { throw SpecError(place() + ": " + message); }

void read_yaml_file(const std::string& path, std::span<const YamlSetting> settings,
                    const std::function<void(ConfigVisitor&)>& body) {
  const YamlSource source{path, folder_of(path)};
  const YAML::Node root = parse_strictly(text_of_file(path), source);
  const YamlOverlay overlay(root, source, {settings.begin(), settings.end()});
  try {
    YamlReader reader(root, source, "", &overlay);
    body(reader);
    reader.check_all_used();
  } catch (const SpecError& error) {
    const std::string message = one_line(error.what());  // as read_yaml_text
    throw SpecError(overlay.names_a_file(message) ? message : path + ": " + message);
  }
}

}  // namespace binpick

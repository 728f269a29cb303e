#include "core/yaml_reader.hpp"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>

#include "core/error.hpp"
#include "core/one_line.hpp"
#include "core/quantity.hpp"
#include "core/yaml.hpp"

namespace binpick {
namespace {

std::string place(const YamlSource& source, const YAML::Mark& mark) {
  return mark.is_null() ? source.name : source.name + ":" + std::to_string(mark.line + 1);
}

/// Bytes of the UTF-8 character at `at`; 0 where there is none. Overlong forms and surrogates are left to the parser.
std::size_t character_size(const std::string& text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xc2 ? 0
                           : first < 0xe0 ? 2
                           : first < 0xf0 ? 3
                           : first < 0xf5 ? 4
                                          : 0;
  if (size > text.size() - at) return 0;
  for (std::size_t k = 1; k < size; ++k)
    if ((static_cast<unsigned char>(text[at + k]) & 0xc0) != 0x80) return 0;
  return size;
}

// The parser takes byte 4 for the end of its input, and after some other bytes finds documents without end.
void check_characters(const std::string& text, const YamlSource& source) {
  int line = 1;
  for (std::size_t at = 0, size = 0; at < text.size(); at += size) {
    const char c = text[at];
    size = character_size(text, at);
    if (size == 0 || (is_control(c) && c != '\n' && c != '\r' && c != '\t'))
      throw SpecError(source.name + ":" + std::to_string(line) + ": holds a byte that is no text in UTF-8");
    line += c == '\n';
  }
}

// Repeated keys and runaway documents; recursion depth is bounded by the parser's own limit.
void check_node(const YAML::Node& node, const YamlSource& source, int& budget) {
  if (--budget < 0) throw SpecError(source.name + ": more than 100000 values");
  if (node.IsSequence())
    for (const auto& item : node) check_node(item, source, budget);
  if (!node.IsMap()) return;
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) throw SpecError(place(source, entry.first.Mark()) + ": a key must be a plain word");
    if (!seen.insert(entry.first.Scalar()).second)
      throw SpecError(place(source, entry.first.Mark()) + ": " + entry.first.Scalar() + ": key appears twice");
    check_node(entry.second, source, budget);
  }
}

// Anchors and aliases make a document of 400 bytes unfold into billions of values: the event stream shows them before
// any tree is walked. So it does a second document.
class AnchorCheck : public YAML::EventHandler {
 public:
  explicit AnchorCheck(const YamlSource& source) : source_(source) {}
  void OnDocumentStart(const YAML::Mark&) override {
    if (++documents_ > 1) throw SpecError(source_.name + ": more than one document");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { check(mark, anchor); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { check(mark, 1); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string&) override {
    check(mark, anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    check(mark, anchor);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    check(mark, anchor);
  }
  void OnMapEnd() override {}

 private:
  void check(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor != 0) throw SpecError(place(source_, mark) + ": anchors and aliases are not allowed");
  }
  const YamlSource& source_;
  int documents_ = 0;
};

}  // namespace

YAML::Node parse_strictly(const std::string& text, const YamlSource& source) {
  check_characters(text, source);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    AnchorCheck check(source);
    while (parser.HandleNextDocument(check)) {
    }
    const YAML::Node document = YAML::Load(text);
    if (document.IsNull()) throw SpecError(source.name + ": the file is empty");
    if (!document.IsMap()) throw SpecError(source.name + ": must hold `key: value` lines");
    int budget = 100000;
    check_node(document, source, budget);
    return document;
  } catch (const YAML::Exception& error) {
    throw SpecError(place(source, error.mark) + ": " + error.msg);
  }
}

YamlReader::YamlReader(const YAML::Node& node, const YamlSource& source, std::string prefix)
    : node_(node), source_(source), prefix_(std::move(prefix)) {}

std::string YamlReader::dotted(const std::string& key) const { return prefix_.empty() ? key : prefix_ + "." + key; }

void YamlReader::fail_at(const YAML::Mark& mark, const std::string& key, const std::string& message) const {
  throw SpecError(place(source_, mark) + ": " + dotted(key) + ": " + message);
}

YAML::Node YamlReader::take(const char* key) {
  asked_.insert(key);
  const YAML::Node& mapping = node_;  // const: operator[] must not create the key
  return mapping[key];
}

std::string YamlReader::scalar(const YAML::Node& node, const std::string& key) const {
  if (!node.IsScalar()) fail_at(node.Mark(), key, "must be a single value");
  // A path would end at a zero byte, a name would break the line of every message and table that shows it.
  const std::string& text = node.Scalar();
  if (std::any_of(text.begin(), text.end(), is_control)) fail_at(node.Mark(), key, "holds a control character");
  return text;
}

double YamlReader::number(const YAML::Node& node, const std::string& key, Unit unit) const {
  const std::string text = scalar(node, key);
  try {
    return parse_quantity(text, unit);
  } catch (const SpecError& error) {
    fail_at(node.Mark(), key, error.what());
  }
}

std::vector<double> YamlReader::numbers(const YAML::Node& node, const std::string& key, Unit unit) const {
  if (!node.IsSequence()) fail_at(node.Mark(), key, "must be a list of numbers, like [0.4, 0.3, 0.2]");
  std::vector<double> values;
  for (const auto& item : node) values.push_back(number(item, key, unit));
  return values;
}

void YamlReader::field(const char* key, double& value, Unit unit, const char*) {
  if (const YAML::Node node = take(key)) value = number(node, key, unit);
}

void YamlReader::field(const char* key, int& value, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  const std::string text = scalar(node, key);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    fail_at(node.Mark(), key, "'" + text + "' is not a whole number");
}

void YamlReader::field(const char* key, bool& value, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  const std::string text = scalar(node, key);
  if (text != "true" && text != "false") fail_at(node.Mark(), key, "must be true or false");
  value = text == "true";
}

void YamlReader::field(const char* key, std::string& value, const char*) {
  if (const YAML::Node node = take(key)) value = scalar(node, key);
}

void YamlReader::field(const char* key, Eigen::Vector3d& value, Unit unit, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  const std::vector<double> read = numbers(node, key, unit);
  if (read.size() != 3) fail_at(node.Mark(), key, "needs three numbers, has " + std::to_string(read.size()));
  value = Eigen::Vector3d(read[0], read[1], read[2]);
}

void YamlReader::field(const char* key, std::vector<double>& value, Unit unit, const char*) {
  if (const YAML::Node node = take(key)) value = numbers(node, key, unit);
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
  const YAML::Node node = take(key);
  if (!node) return;
  const std::string text = scalar(node, key);
  if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
    std::string all;
    for (const std::string& name : allowed) all += (all.empty() ? "" : ", ") + name;
    const std::string near = nearest_name(text, allowed);
    fail_at(node.Mark(), key,
            "'" + text + "' is not known" + (near.empty() ? "" : ", did you mean " + near + "?") + " (one of: " + all +
                ")");
  }
  value = text;
}

void YamlReader::path(const char* key, std::string& value, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  const std::filesystem::path read = scalar(node, key);
  if (read.empty()) fail_at(node.Mark(), key, "is empty");
  value = from_here(read);
}

std::string YamlReader::from_here(const std::filesystem::path& read) const {
  return (read.is_absolute() ? read : std::filesystem::path(source_.folder) / read).lexically_normal().string();
}

void YamlReader::command(const char* key, std::vector<std::string>& value, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  if (!node.IsSequence()) fail_at(node.Mark(), key, "must be a list: [program, argument, ..]");
  value.clear();
  for (const auto& item : node) {
    const std::string text = scalar(item, key);
    value.push_back(is_path_item(text) ? from_here(text) : text);
  }
}

void YamlReader::section_with(const char* key, const std::function<void(ConfigVisitor&)>& body, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  if (!node.IsMap()) fail_at(node.Mark(), key, "must be a mapping of `key: value`");
  YamlReader nested(node, source_, dotted(key));
  body(nested);
  nested.check_all_used();
}

void YamlReader::list_with(const char* key, std::size_t, const std::function<void(std::size_t)>& resize,
                           const std::function<void(std::size_t, ConfigVisitor&)>& body, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  if (!node.IsSequence()) fail_at(node.Mark(), key, "must be a list");
  resize(node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    const std::string item = dotted(key) + "[" + std::to_string(i) + "]";
    if (!node[i].IsMap()) fail_at(node[i].Mark(), key, "every item must be a mapping of `key: value`");
    YamlReader nested(node[i], source_, item);
    body(i, nested);
    nested.check_all_used();
  }
}

bool YamlReader::has(const char* key) const { return static_cast<bool>(node_[key]); }

bool YamlReader::is_scalar(const char* key) const {
  const YAML::Node node = node_[key];
  return node && node.IsScalar();
}

void YamlReader::fail(const char* key, const std::string& message) const {
  const YAML::Node node = node_[key];
  fail_at(node ? node.Mark() : node_.Mark(), key, message);
}

void YamlReader::check_all_used() const {
  const std::vector<std::string> known(asked_.begin(), asked_.end());
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (asked_.count(key)) continue;
    const std::string near = nearest_name(key, known);
    fail_at(entry.first.Mark(), key, "unknown key" + (near.empty() ? "" : ", did you mean " + dotted(near) + "?"));
  }
}

}  // namespace binpick

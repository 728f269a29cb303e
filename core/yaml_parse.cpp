#include <yaml-cpp/eventhandler.h>

#include <set>
#include <sstream>

#include "core/error.hpp"
#include "core/one_line.hpp"
#include "core/yaml_reader.hpp"

namespace binpick {

std::string place(const YamlSource& source, const YAML::Mark& mark) {
  return mark.is_null() ? source.name : source.name + ":" + std::to_string(mark.line + 1);
}

namespace {

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

}  // namespace binpick

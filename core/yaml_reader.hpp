// Private to core: a ConfigVisitor that fills values from one YAML mapping.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/config.hpp"

namespace binpick {

struct YamlSource {
  std::string name;    ///< the file in messages
  std::string folder;  ///< what paths are relative to
};

/// "scene.yaml:14"; without a mark the name alone.
std::string place(const YamlSource& source, const YAML::Mark& mark);

/// Parses one document whose root is a mapping; refuses anchors, aliases, repeated keys, too many or too deep nodes.
YAML::Node parse_strictly(const std::string& text, const YamlSource& source);

class YamlOverlay;

class YamlReader : public ConfigVisitor {
 public:
  /// `prefix` is the dotted path of this mapping, "" for the root. `overlay`: what is set over the document; it
  /// outlives the reader.
  YamlReader(const YAML::Node& node, const YamlSource& source, std::string prefix,
             const YamlOverlay* overlay = nullptr);

  bool reading() const override { return true; }
  void field(const char* key, double& value, Unit unit, const char* help) override;
  void field(const char* key, int& value, const char* help) override;
  void field(const char* key, bool& value, const char* help) override;
  void field(const char* key, std::string& value, const char* help) override;
  void field(const char* key, Eigen::Vector3d& value, Unit unit, const char* help) override;
  void field(const char* key, std::vector<double>& value, Unit unit, const char* help) override;
  void field(const char* key, Pose& value, const char* help) override;
  void choice(const char* key, std::string& value, const std::vector<std::string>& allowed, const char* help) override;
  void path(const char* key, std::string& value, const char* help) override;
  void command(const char* key, std::vector<std::string>& value, const char* help) override;
  void section_with(const char* key, const std::function<void(ConfigVisitor&)>& body, const char* help) override;
  void list_with(const char* key, std::size_t size, const std::function<void(std::size_t)>& resize,
                 const std::function<void(std::size_t, ConfigVisitor&)>& body, const char* help) override;
  bool has(const char* key) const override;
  bool is_scalar(const char* key) const override;
  void fail(const char* key, const std::string& message) const override;

  /// Somebody else reads this key.
  void leave(const std::string& key) { asked_.insert(key); }
  /// Throws at the first key of the mapping that nothing asked for.
  void check_all_used() const;

 private:
  /// A value, and the file that it stands in.
  struct Found {
    YAML::Node node;
    const YamlSource* source;
    explicit operator bool() const { return static_cast<bool>(node); }
    std::string from_here(const std::filesystem::path& read) const;  ///< absolute; relative ones begin at the file
  };
  Found find(const char* key) const;
  Found take(const char* key);
  Found item(const Found& list, const std::string& key, std::size_t index) const;
  double number(const Found& found, const std::string& key, Unit unit) const;
  std::vector<double> numbers(const Found& found, const std::string& key, Unit unit) const;
  std::string scalar(const Found& found, const std::string& key) const;
  std::string dotted(const std::string& key) const;
  [[noreturn]] void fail_at(const Found& found, const std::string& key, const std::string& message) const;
  [[noreturn]] void fail_unknown(const Found& found, const std::string& key) const;

  YAML::Node node_;
  YamlSource source_;
  std::string prefix_;
  const YamlOverlay* overlay_;
  std::set<std::string> asked_;
};

}  // namespace binpick

// Private to core: ConfigVisitors that write a configuration out, as YAML or as a documentation table.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/yaml.hpp"

namespace binpick {

/// What both writers share: they only look, so nothing is read and nothing fails.
class ConfigOutput : public ConfigVisitor {
 public:
  bool reading() const override { return false; }
  bool has(const char*) const override { return false; }
  bool is_scalar(const char*) const override { return false; }
  void fail(const char*, const std::string&) const override {}
};

class YamlWriter : public ConfigOutput {
 public:
  explicit YamlWriter(std::string folder, FileNaming naming = {});
  std::string text();

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

 private:
  void numbers(const char* key, const double* values, std::size_t count);
  YAML::Emitter out_;
  std::string shown(const std::string& file) const;
  std::string folder_;
  FileNaming naming_;
  bool ended_ = false;
};

class ConfigDescriber : public ConfigOutput {
 public:
  std::string text() const;

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

 private:
  void row(const char* key, const std::string& value, const char* unit, const char* help);
  std::string rows_;
  std::string prefix_;
};

}  // namespace binpick

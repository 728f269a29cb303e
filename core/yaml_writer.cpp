#include "core/yaml_writer.hpp"

#include <filesystem>

#include "core/quantity.hpp"

namespace binpick {
namespace {

const char* si_name(Unit unit) {
  switch (unit) {
    case Unit::kNone:
      return "";
    case Unit::kLength:
      return "m";
    case Unit::kAngle:
      return "rad";
    case Unit::kTime:
      return "s";
    case Unit::kMass:
      return "kg";
    case Unit::kDensity:
      return "kg/m^3";
    case Unit::kSpeed:
      return "m/s";
    case Unit::kAngularSpeed:
      return "rad/s";
    case Unit::kAcceleration:
      return "m/s^2";
    case Unit::kPressure:
      return "Pa";
    case Unit::kForce:
      return "N";
    case Unit::kStiffness:
      return "N/m";
  }
  return "";
}

std::string joined(const double* values, std::size_t count) {
  std::string text = "[";
  for (std::size_t i = 0; i < count; ++i) text += (i ? ", " : "") + format_double(values[i]);
  return text + "]";
}

}  // namespace

YamlWriter::YamlWriter(std::string folder, FileNaming naming) : folder_(std::move(folder)), naming_(std::move(naming)) {
  out_ << YAML::BeginMap;
}

std::string YamlWriter::text() {
  if (!ended_) out_ << YAML::EndMap;
  ended_ = true;
  return std::string(out_.c_str()) + "\n";
}

void YamlWriter::field(const char* key, double& value, Unit, const char*) {
  out_ << YAML::Key << key << YAML::Value << format_double(value);
}
void YamlWriter::field(const char* key, int& value, const char*) { out_ << YAML::Key << key << YAML::Value << value; }
void YamlWriter::field(const char* key, bool& value, const char*) {
  out_ << YAML::Key << key << YAML::Value << (value ? "true" : "false");
}
void YamlWriter::field(const char* key, std::string& value, const char*) {
  out_ << YAML::Key << key << YAML::Value << value;
}
void YamlWriter::numbers(const char* key, const double* values, std::size_t count) {
  out_ << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (std::size_t i = 0; i < count; ++i) out_ << format_double(values[i]);
  out_ << YAML::EndSeq;
}
void YamlWriter::field(const char* key, Eigen::Vector3d& value, Unit, const char*) { numbers(key, value.data(), 3); }
void YamlWriter::field(const char* key, std::vector<double>& value, Unit, const char*) {
  numbers(key, value.data(), value.size());
}
void YamlWriter::field(const char* key, Pose& value, const char*) {
  const Eigen::Vector3d xyz = value.translation(), rpy = stored_rpy(value.linear());
  out_ << YAML::Key << key << YAML::Value << YAML::BeginMap;
  numbers("xyz", xyz.data(), 3);
  numbers("rpy", rpy.data(), 3);
  out_ << YAML::EndMap;
}
void YamlWriter::choice(const char* key, std::string& value, const std::vector<std::string>&, const char* help) {
  field(key, value, help);
}
void YamlWriter::path(const char* key, std::string& value, const char* help) {
  if (value.empty()) return;  // an unset optional path is left out, as an empty one is refused on reading
  std::string name = shown(value);
  field(key, name, help);
}
std::string YamlWriter::shown(const std::string& file) const {
  if (folder_.empty()) return file;
  std::error_code error;
  const std::filesystem::path relative = std::filesystem::relative(file, folder_, error);
  return error || relative.empty() ? file : relative.string();
}
void YamlWriter::command(const char* key, std::vector<std::string>& value, const char*) {
  out_ << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const std::string& item : value) {
    std::string name = item;
    if (is_path_item(item)) name = naming_ ? naming_(item) : shown(item);
    if (is_path_item(item) && !naming_ && !is_path_item(name)) name = "./" + name;  // a path when it is read again
    out_ << YAML::DoubleQuoted << name;
  }
  out_ << YAML::EndSeq;
}
void YamlWriter::section_with(const char* key, const std::function<void(ConfigVisitor&)>& body, const char*) {
  out_ << YAML::Key << key << YAML::Value << YAML::BeginMap;
  body(*this);
  out_ << YAML::EndMap;
}
void YamlWriter::list_with(const char* key, std::size_t size, const std::function<void(std::size_t)>&,
                           const std::function<void(std::size_t, ConfigVisitor&)>& body, const char*) {
  out_ << YAML::Key << key << YAML::Value << YAML::BeginSeq;
  for (std::size_t i = 0; i < size; ++i) {
    out_ << YAML::BeginMap;
    body(i, *this);
    out_ << YAML::EndMap;
  }
  out_ << YAML::EndSeq;
}

std::string ConfigDescriber::text() const {
  return "| key | default | unit | meaning |\n| --- | --- | --- | --- |\n" + rows_;
}

void ConfigDescriber::row(const char* key, const std::string& value, const char* unit, const char* help) {
  rows_ += "| `" + prefix_ + key + "` | " + value + " | " + unit + " | " + help + " |\n";
}
void ConfigDescriber::field(const char* key, double& value, Unit unit, const char* help) {
  row(key, format_double(value), si_name(unit), help);
}
void ConfigDescriber::field(const char* key, int& value, const char* help) {
  row(key, std::to_string(value), "", help);
}
void ConfigDescriber::field(const char* key, bool& value, const char* help) {
  row(key, value ? "true" : "false", "", help);
}
void ConfigDescriber::field(const char* key, std::string& value, const char* help) { row(key, value, "", help); }
void ConfigDescriber::field(const char* key, Eigen::Vector3d& value, Unit unit, const char* help) {
  row(key, joined(value.data(), 3), si_name(unit), help);
}
void ConfigDescriber::field(const char* key, std::vector<double>& value, Unit unit, const char* help) {
  row(key, joined(value.data(), value.size()), si_name(unit), help);
}
void ConfigDescriber::field(const char* key, Pose& value, const char* help) {
  const Eigen::Vector3d xyz = value.translation(), rpy = stored_rpy(value.linear());
  row(key, "{xyz: " + joined(xyz.data(), 3) + ", rpy: " + joined(rpy.data(), 3) + "}", "m, rad", help);
}
void ConfigDescriber::choice(const char* key, std::string& value, const std::vector<std::string>& allowed,
                             const char* help) {
  std::string all;
  for (const std::string& name : allowed) all += (all.empty() ? "" : ", ") + name;
  row(key, value, ("one of: " + all).c_str(), help);
}
void ConfigDescriber::path(const char* key, std::string& value, const char* help) { row(key, value, "path", help); }
void ConfigDescriber::command(const char* key, std::vector<std::string>& value, const char* help) {
  std::string all;
  for (const std::string& item : value) all += (all.empty() ? "" : ", ") + item;
  row(key, "[" + all + "]", "program and arguments", help);
}
void ConfigDescriber::section_with(const char* key, const std::function<void(ConfigVisitor&)>& body, const char* help) {
  row(key, "", "mapping", help);
  const std::string outer = prefix_;
  prefix_ += std::string(key) + ".";
  body(*this);
  prefix_ = outer;
}
void ConfigDescriber::list_with(const char* key, std::size_t size, const std::function<void(std::size_t)>&,
                                const std::function<void(std::size_t, ConfigVisitor&)>& body, const char* help) {
  row(key, std::to_string(size) + " items", "list", help);
  const std::string outer = prefix_;
  prefix_ += std::string(key) + "[].";
  if (size > 0) body(0, *this);
  prefix_ = outer;
}

}  // namespace binpick

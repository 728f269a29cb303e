#include <sstream>

#include "core/error.hpp"
#include "core/yaml.hpp"
#include "sim/sensors/models.hpp"

namespace binpick {

const std::vector<SensorEntry>& sensor_registry() {
  static const std::vector<SensorEntry> entries = {
      {"active_stereo", "two infrared images with projected dots, matched (RealSense D4xx)", make_active_stereo_sensor},
      {"disparity", "stereo camera, noise made in the disparity domain (RealSense D4xx)", make_disparity_sensor},
      {"gauss_z", "white Gaussian noise on depth: a baseline, too easy for ICP", make_gauss_z_sensor},
      {"ideal", "exact depth", make_ideal_sensor},
      {"structured_light", "phase-shifted stripes, projected and decoded (Zivid, PhoXi)", make_structured_light_sensor},
  };
  return entries;
}

std::vector<std::string> sensor_names() {
  std::vector<std::string> names;
  for (const SensorEntry& entry : sensor_registry()) names.push_back(entry.name);
  return names;
}

std::unique_ptr<SensorModel> make_sensor(const std::string& name) {
  for (const SensorEntry& entry : sensor_registry())
    if (entry.name == name) return entry.make();
  const std::string near = nearest_name(name, sensor_names());
  throw SpecError("sensor type '" + name + "' is not known" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

void check_depth_range(const char* model, double z_min, double z_max) {
  if (z_min >= 0.01 && z_max > z_min && z_max <= 20) return;
  std::ostringstream text;
  text << model << ": z_min " << z_min << " m and z_max " << z_max << " m must satisfy 10 mm <= z_min < z_max <= 20 m";
  throw SpecError(text.str());
}

void check_between(const char* model, const char* key, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream text;
  text << model << ": " << key << " is " << value << " and must lie between " << low << " and " << high;
  throw SpecError(text.str());
}

}  // namespace binpick

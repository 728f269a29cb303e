// Every metric, one line each.
#include "core/error.hpp"
#include "core/yaml.hpp"
#include "evaluation/metric.hpp"

namespace binpick {

std::unique_ptr<Metric> make_translation_metric();
std::unique_ptr<Metric> make_rotation_metric();
std::unique_ptr<Metric> make_add_metric();
std::unique_ptr<Metric> make_add_s_metric();
std::unique_ptr<Metric> make_mssd_metric();

const std::vector<MetricEntry>& metric_registry() {
  static const std::vector<MetricEntry> entries = {
      {"translation", Unit::kLength, "distance of the bounding-box centres", make_translation_metric},
      {"rotation", Unit::kAngle, "angle between the orientations, least over the symmetries", make_rotation_metric},
      {"add", Unit::kLength, "mean distance of corresponding vertices at the nearest twin", make_add_metric},
      {"add_s", Unit::kLength, "mean distance of true vertices to the nearest estimated one", make_add_s_metric},
      {"mssd", Unit::kLength, "largest surface distance, least over the symmetries", make_mssd_metric},
  };
  return entries;
}

std::unique_ptr<Metric> make_metric(const std::string& name) {
  std::vector<std::string> names;
  for (const MetricEntry& entry : metric_registry()) {
    if (entry.name == name) return entry.make();
    names.push_back(entry.name);
  }
  throw SpecError("unknown metric '" + name + "', did you mean '" + nearest_name(name, names) + "'?");
}

}  // namespace binpick

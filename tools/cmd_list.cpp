// binpick list [KIND]: what a scene can choose from, with every parameter, its default, unit and meaning;
// sensor_presets: what --sensor accepts.

#include <cstdio>
#include <iostream>

#include "core/cup_models.hpp"
#include "core/yaml.hpp"
#include "perception/pose_estimator.hpp"
#include "robot/gripper.hpp"
#include "sim/sensor_model.hpp"
#include "tools/commands.hpp"
#include "trials/scenario.hpp"

namespace binpick {
namespace {

template <class Registry>
void print_registry(const char* title, const Registry& registry) {
  std::cout << "# " << title << "\n\n";
  for (const auto& entry : registry) {
    const auto made = entry.make();
    std::cout << "## " << entry.name << "\n"
              << entry.help << "\n\n"
              << describe_config([&](ConfigVisitor& v) { made->visit(v); }) << "\n";
  }
}

// What `model:` of a cup accepts, and its main figures.
void print_cups() {
  std::cout << "# cups (gripper.cups: - {model: NAME, pose: ...}; sources in core/cup_models.hpp)\n\n"
            << "| model | cup | holds at 60 kPa, N | stroke, mm | stiffness, N/mm | friction | builds up in, ms |\n"
            << "|---|---|---|---|---|---|---|\n";
  for (const CupModel& model : cup_models()) {
    const CupSpec& cup = model.spec;
    char row[160];
    std::snprintf(row, sizeof row, "| %s | %s | %.2f | %.1f | %g | %g | %.0f |\n", model.name.c_str(),
                  model.help.c_str(), cup.limits().pull, 1e3 * cup.stroke, 1e-3 * cup.lip_stiffness, cup.friction,
                  1e3 * cup.time_constant);
    std::cout << row;
  }
  std::cout << "\n";
}

// What --sensor accepts, a line each: for scripts.
void print_sensor_presets() {
  for (const SensorEntry& entry : sensor_registry()) {
    const std::vector<std::string> presets = entry.make()->presets();
    if (presets.empty()) std::cout << entry.name << "\n";
    for (const std::string& preset : presets) std::cout << entry.name << ":" << preset << "\n";
  }
}

void print_scene_keys() {
  Scenario scenario;
  scenario.parts.resize(1);
  std::cout << "# scene keys\n\n"
            << describe_config([&](ConfigVisitor& v) {
                 scenario.visit(v);
                 v.section("calibration", scenario.calibration,
                           "");  // which a stored scene leaves out while it is perfect
               })
            << "\n";
}

}  // namespace

Action add_list(CLI::App& app) {
  auto kind = std::make_shared<std::string>("all");
  CLI::App* command = app.add_subcommand("list", "sensors, estimators, grippers and scene keys, with their parameters");
  command->add_option("kind", *kind, "what to list")
      ->check(CLI::IsMember({"all", "sensors", "estimators", "grippers", "cups", "scene", "sensor_presets"}));
  return [kind] {
    const bool all = *kind == "all";
    if (*kind == "sensor_presets") print_sensor_presets();
    if (all || *kind == "sensors") print_registry("sensors", sensor_registry());
    if (all || *kind == "estimators") print_registry("estimators", estimator_registry());
    if (all || *kind == "grippers") print_registry("grippers", gripper_registry());
    if (all || *kind == "grippers" || *kind == "cups") print_cups();
    if (all || *kind == "scene") print_scene_keys();
    return 0;
  };
}

}  // namespace binpick

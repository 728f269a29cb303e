// A sweep: one scenario, factors over any of its fields, the same seeds in every cell (docs/sweeps.md). Read from a
// strict YAML file, expanded to cells; every cell is a scenario of its own.
//
//   base: bearing_bin.yaml
//   seeds: 5000:5020
//   factors:
//     sensor.preset: [d435_848, d415_1280]                      # path of a field: its levels
//     height: {field: "cell.look.camera.xyz[2]", levels: {500 mm: 505 mm, 600 mm: 605 mm}}
//     tool:                                                     # several fields under one name
//       levels:
//         three cups: {cell.gripper.preset: three_cups}
//         two cups: {cell.gripper.preset: two_cups, planning.clearance: 4 mm}
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/yaml_value.hpp"
#include "evaluation/sweep_plan.hpp"
#include "trials/scenario.hpp"

namespace binpick {

struct SweepSetup {
  /// One level: its settings, and the text that stands for it.
  struct Level {
    std::string label;
    std::vector<YamlSetting> settings;
  };
  /// Drawn between two numbers of one unit, in steps where there is a step.
  struct Range {
    std::string field, unit;
    double low = 0, high = 1, step = 0;
    YamlValue at;
  };
  struct Factor {
    std::string name;
    YamlValue at;
    std::vector<std::string> fields;
    std::vector<Level> levels;   ///< to choose from
    std::optional<Range> range;  ///< instead of levels
  };

  std::string file, base;
  SweepPlan plan;  ///< its cells are in the order of `settings`
  int points = 0;  ///< of a Latin hypercube
  std::uint64_t seed = 1;
  std::vector<Factor> factors;
  std::vector<std::vector<YamlSetting>> settings;  ///< of each cell
};

/// Reads and expands. Throws SpecError that names file and line: an unknown key, a factor that cannot be meant.
SweepSetup read_sweep(const std::string& path);

/// The scenario of one cell. Throws SpecError that names the level at fault: its file and line, and the field.
Scenario cell_scenario(const SweepSetup& sweep, std::size_t cell);

/// Private to this folder: fills plan.cells and settings from the factors.
void expand_grid(SweepSetup& sweep);
void expand_latin_hypercube(SweepSetup& sweep);

}  // namespace binpick

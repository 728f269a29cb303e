// A sweep as data: factors with their levels, and cells, which are runs of one scenario each on the same seeds. What
// `sweep.json` keeps of a sweep, so that its tables can be made wherever its run folders are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace binpick {

inline constexpr int kSweepSchema = 1;

struct SweepFactorPlan {
  std::string name;
  std::vector<std::string> fields;  ///< paths of the scenario's fields that it sets
  std::vector<std::string> levels;  ///< labels; of a range, its equal parts
  bool range = false;               ///< drawn between two ends: cells of one level differ in value
};

struct SweepCellPlan {
  std::string folder;               ///< run folder, relative to the sweep's
  std::vector<std::size_t> levels;  ///< of each factor
  std::vector<std::string> values;  ///< of each factor: the level's label, or what was drawn
};

struct SweepPlan {
  std::string name, base;
  std::string design = "grid";        ///< grid | latin_hypercube
  std::string objective = "cleared";  ///< cleared | picks: what the best cell is best in
  double alpha = 0.05;                ///< chance that any cell or level is called worse and is not
  std::uint64_t first_seed = 0, end_seed = 0;
  std::vector<SweepFactorPlan> factors;
  std::vector<SweepCellPlan> cells;
};

/// "500 mm, three_cups".
std::string cell_label(const SweepCellPlan& cell);

/// From the `sweep.json` of a folder. Throws SpecError, AssetError: one line that names the file.
SweepPlan read_sweep_plan(const std::string& folder);

}  // namespace binpick

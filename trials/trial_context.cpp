#include "trials/trial_context.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/quantity.hpp"
#include "sim/bin_pieces.hpp"
#include "trials/calibration/calibration_setup.hpp"

namespace binpick {
namespace {

constexpr int kMostParts = 500;  // as for counts

// A part fits when it can lie in the bin in some turn about the vertical: its two smaller extents against the floor.
void check_fits(const Part& part, const BinSpec& bin, const std::string& scene_file) {
  Eigen::Vector3d extent = bounding_box(part.mesh_P).sizes();
  std::sort(extent.data(), extent.data() + 3);
  Eigen::Vector2d floor = bin.inner_size.head<2>();
  std::sort(floor.data(), floor.data() + 2);
  if (extent[1] >= floor[0] || extent[2] >= floor.norm())
    throw SpecError(scene_file + ": cell.bin.inner_size: the bin's floor of " + format_double(floor[1]) + " x " +
                    format_double(floor[0]) + " m is smaller than the part " + part.name + " (" +
                    format_double(extent[2]) + " x " + format_double(extent[1]) + " m)");
}

CalibrationSetup calibration_of(const Scenario& s) {
  try {
    return calibration_setup(s.cell, {s.calibration.method == "hand_eye" ? s.calibration.poses : 0});
  } catch (const SpecError& error) {
    throw SpecError(s.file + ": " + error.what());
  }
}

}  // namespace

// As the scene says; or, with a fill level, in the scene's proportions so many that they fill the bin to it.
std::vector<int> dropped_counts(const Scenario& scenario, const std::vector<Part>& parts) {
  std::vector<int> counts;
  double volume = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    counts.push_back(scenario.parts[i].count);
    volume += counts.back() * parts[i].mass.volume;
  }
  if (scenario.drop.fill == 0) return counts;
  const double factor = scenario.drop.fill * scenario.cell.bin.volume() / volume;
  double total = 0;
  for (int& count : counts) {
    total += std::round(count * factor);
    if (total > kMostParts)
      throw SpecError(scenario.file + ": drop.fill: takes more than " + std::to_string(kMostParts) + " parts");
    count = static_cast<int>(std::lround(count * factor));
  }
  if (total == 0) throw SpecError(scenario.file + ": drop.fill: less than one part fills the bin so far");
  return counts;
}

TrialContext make_trial_context(Scenario& scenario) {
  TrialContext context;
  prepare_bin(scenario.cell.bin);
  for (const PartEntry& entry : scenario.parts) {
    context.parts.push_back(load_part(entry.spec));
    check_fits(context.parts.back(), scenario.cell.bin, scenario.file);
    context.shapes.push_back(collision_shape(context.parts.back()));
    context.probes.push_back(probe_of(context.parts.back()));
  }
  context.counts = dropped_counts(scenario, context.parts);
  context.hash = scenario_hash(scenario);
  context.renderer = make_renderer(scenario.renderer);
  context.planner = std::make_unique<const PickPlanner>(scenario.cell, context.parts, scenario.planning);
  context.checker = std::make_unique<const PoseChecker>(context.parts);
  if (scenario.calibration.by_measurement())
    context.calibration = std::make_shared<const CalibrationSetup>(calibration_of(scenario));
  if (scenario.estimator) scenario.estimator->prepare(context.parts);
  return context;
}

}  // namespace binpick

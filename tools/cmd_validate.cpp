// binpick validate SUBJECT: the numbered physical checks, measured and judged. Exit 0 when all pass, 1 otherwise.

#include <algorithm>
#include <iostream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "tools/commands.hpp"
#include "tools/validate/calibration_bench.hpp"
#include "tools/validate/calibration_plots.hpp"
#include "tools/validate/physics_bench.hpp"
#include "tools/validate/sensor_plots.hpp"
#include "tools/validate/suction_bench.hpp"

namespace binpick {
namespace {

constexpr int kQuickSeeds = 4, kQuickCalibrations = 100;

struct Options {
  std::string subject, json, plots, seeds;
  bool quick = false;
  int threads = 2;
};

void drawn_or_said(bool drawn, const std::string& folder) {
  if (!drawn)
    std::cerr << "gnuplot is not installed: " << folder << " has the curves and scripts, no pictures" << std::endl;
}

std::vector<Verdict> validate_sensors(const Options& options) {
  auto [first, last] = std::pair<std::uint64_t, std::uint64_t>(5000, 5000 + SensorBench::kFullSeeds);
  if (options.quick) last = first + kQuickSeeds;
  if (!options.seeds.empty()) std::tie(first, last) = parse_seeds(options.seeds);
  if (last - first > 1000) throw SpecError("--seeds: at most 1000");
  SensorBench bench(first, static_cast<int>(last - first), options.quick, options.threads);
  for (void (*check)(SensorBench&) : {check_wall_noise, check_kinect_noise, check_shadow, check_depth_steps,
                                      check_noise_correlation, check_matching, check_bias})
    check(bench);
  if (!options.plots.empty()) {
    SensorBench middle(first, static_cast<int>(last - first), true, options.threads);
    drawn_or_said(plot_sensors(middle, options.plots), options.plots);
  }
  return bench.verdicts();
}

std::vector<Verdict> validate_suction(const Options& options) {
  auto [first, last] = std::pair<std::uint64_t, std::uint64_t>(5000, 5000 + SuctionBench::kFullDraws);
  if (options.quick) last = first + kQuickSeeds;
  if (!options.seeds.empty()) std::tie(first, last) = parse_seeds(options.seeds);
  if (last - first > 1000) throw SpecError("--seeds: at most 1000");
  SuctionBench bench(first, static_cast<int>(last - first));
  for (void (*check)(SuctionBench&) :
       {check_pull_off, check_slip, check_lift, check_lever_arm, check_curvature, check_ring_edge})
    check(bench);
  if (!options.plots.empty()) drawn_or_said(plot_suction(options.plots), options.plots);
  return bench.verdicts();
}

std::vector<Verdict> validate_physics(const Options& options) {
  auto [first, last] = std::pair<std::uint64_t, std::uint64_t>(5000, 5000 + PhysicsBench::kFullDraws);
  if (options.quick) last = first + kQuickSeeds;
  if (!options.seeds.empty()) std::tie(first, last) = parse_seeds(options.seeds);
  if (last - first > 1000) throw SpecError("--seeds: at most 1000");
  PhysicsBench bench(first, static_cast<int>(last - first), options.quick, options.threads);
  // The bearings first: outside the project's folder their scene is missed at once.
  for (void (*check)(PhysicsBench&) : {check_bearings, check_invariance, check_single_body, check_cylinders,
                                       check_cuboids, check_thrown_cuboids, check_rest, check_spheres})
    check(bench);
  std::vector<Verdict> lines = bench.verdicts();
  if (!options.plots.empty()) drawn_or_said(plot_physics(lines, options.plots), options.plots);
  std::stable_sort(lines.begin(), lines.end(), [](const Verdict& a, const Verdict& b) { return a.id < b.id; });
  return lines;
}

std::vector<Verdict> validate_calibration(const Options& options) {
  auto [first, last] = std::pair<std::uint64_t, std::uint64_t>(5000, 5000 + CalibrationBench::kFullDraws);
  if (options.quick) last = first + kQuickCalibrations;
  if (!options.seeds.empty()) std::tie(first, last) = parse_seeds(options.seeds);
  if (last - first > 100000) throw SpecError("--seeds: at most 100000");
  CalibrationBench bench(first, static_cast<int>(last - first));
  for (void (*check)(CalibrationBench&) : {check_plate_pose, check_chain, report_pick_error, check_hand_eye})
    check(bench);
  if (!options.plots.empty())
    drawn_or_said(plot_calibration(*bench.setup().cell, {}, first, static_cast<int>(last - first), options.plots),
                  options.plots);
  return bench.verdicts();
}

std::vector<Verdict> validate(const Options& options) {
  if (options.subject == "calibration") return validate_calibration(options);
  if (options.subject == "physics") return validate_physics(options);
  return options.subject == "suction" ? validate_suction(options) : validate_sensors(options);
}

int run(const Options& options) {
  if (!options.json.empty()) write_file(options.json, "[]\n");  // a place that cannot be written is known at once
  if (!options.plots.empty()) make_folder(options.plots);
  const std::vector<Verdict> verdicts = validate(options);
  if (!options.json.empty()) write_file(options.json, json_of(verdicts));
  std::cout << table_of(verdicts) << std::flush;
  if (!std::cout) throw StorageError("standard output: cannot write");
  return all_pass(verdicts) ? 0 : 1;
}

}  // namespace

Action add_validate(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("validate", "physical checks: measured value, expected value, verdict");
  command->add_option("subject", options->subject, "what to check")
      ->required()
      ->check(CLI::IsMember({"sensors", "suction", "physics", "calibration"}));
  command->add_flag("--quick", options->quick, "fewer seeds and smaller images, tolerances widened accordingly");
  command->add_option(
      "--seeds", options->seeds,
      "A:B, seeds A .. B-1; default 5000:5020, quick 5000:5004; calibration 5000:6000, quick 5000:5100");
  command->add_option("--threads", options->threads, "results do not depend on it")->check(CLI::Range(1, 256));
  command->add_option("--json", options->json, "write the verdicts to this file");
  command->add_option("--plots", options->plots, "draw the curves beside the published ones into this folder");
  return [options] { return run(*options); };
}

}  // namespace binpick

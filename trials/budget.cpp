#include "trials/budget.hpp"

#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/quantity.hpp"
#include "trials/run_merge.hpp"

namespace binpick {
namespace {

/// A stage, and the scene's fields that tell it the truth, as YAML.
struct Stage {
  const char* name;
  std::string fields;
  bool perfect;  ///< in the scene already
};

std::string number(double x) { return format_double(x); }

// The ideal sensor has no intrinsics of its own to compare with: those of the scene's camera stay.
std::string ideal_depth(const Scenario& s) {
  const PinholeCamera& c = s.cell.camera.intrinsics;
  return "sensor: {type: ideal}, cell.camera.intrinsics: {width: " + std::to_string(c.width) +
         ", height: " + std::to_string(c.height) + ", fx: " + number(c.fx) + ", fy: " + number(c.fy) +
         ", cx: " + number(c.cx) + ", cy: " + number(c.cy) + "}";
}

// A planner that knows the heap may also search for as long as it likes.
std::vector<Stage> stages_of(const Scenario& s) {
  return {{"depth", ideal_depth(s), s.sensor_type == "ideal"},
          {"segmentation", "oracles.segmentation: true", s.oracles.segmentation || s.estimator_type != "ppf"},
          {"pose", "estimator: {type: oracle}, second_look: off", s.estimator_type == "oracle"},
          {"calibration", "calibration: perfect", s.calibration.perfect()},
          {"planning", "oracles.planning: true, planning.max_candidates: 4000, planning.search_checks: 200000",
           s.oracles.planning},
          {"seal", "oracles.seal: true", s.oracles.seal}};
}

std::string head(const BudgetPlan& plan, const Scenario& s, const std::string& what) {
  return "name: '" + what + "'\nbase: '" + std::filesystem::absolute(s.file).string() +
         "'\nseeds: " + std::to_string(plan.first_seed) + ":" + std::to_string(plan.end_seed) +
         "\nfactors:\n  stage:\n    levels:\n";
}

std::string level(const std::string& name, const std::string& fields) {
  return "      '" + name + "': {" + fields + "}\n";
}

std::string stages_file(const BudgetPlan& plan, const Scenario& s, std::vector<std::string>& absent) {
  std::string text = head(plan, s, "error budget, stages") + level("as it is", "");
  std::string all;
  for (const Stage& stage : stages_of(s)) {
    if (stage.perfect) {
      absent.push_back(stage.name);
      continue;
    }
    text += level(stage.name, stage.fields);
    // With true poses there is nothing to segment.
    if (std::string(stage.name) != "segmentation") all += (all.empty() ? "" : ", ") + stage.fields;
  }
  return text + level("all of them", all);
}

std::string error_level(const char* of, double error) {
  const bool turn = std::string(of) == "rotation";
  const std::string size = number(error) + (turn ? " rad" : " m");
  return level(std::string(of) + " " + number(error), "estimator: {type: oracle, " + std::string(of) + "_error: " +
                                                          size + "}, second_look: off, calibration: perfect");
}

std::string errors_file(const BudgetPlan& plan, const Scenario& s) {
  std::string text = head(plan, s, "error budget, disturbed poses") +
                     level("none", "estimator: {type: oracle}, second_look: off, calibration: perfect");
  for (const double error : plan.translation) text += error_level("translation", error);
  for (const double error : plan.rotation) text += error_level("rotation", error);
  return text;
}

void check_rising(const std::vector<double>& errors, const char* name) {
  double before = 0;
  for (const double error : errors) {
    if (!(error > before)) throw SpecError(std::string(name) + ": errors must be positive and rise");
    before = error;
  }
}

/// The cells of a sweep as runs, those whose first level name begins with `prefix`, and the first.
std::vector<BudgetRun> runs_of(const SweepSetup& sweep, const std::string& folder) {
  std::vector<BudgetRun> runs;
  for (const SweepCellPlan& cell : sweep.plan.cells)
    runs.push_back({cell.values.front(), 0, sweep_records(read_records(folder + "/" + cell.folder))});
  return runs;
}

SweepRun sum(const SweepRun& a, const SweepRun& b) {
  return {a.failed + b.failed, a.interrupted || b.interrupted, a.worker_exit != 0 ? a.worker_exit : b.worker_exit};
}

SweepRun run_part(const std::string& text, const std::string& folder, const CampaignOptions& options,
                  const std::string& program, ProgressSink& progress, std::vector<BudgetRun>& runs) {
  make_folder(folder);
  write_file(folder + "/budget.yaml", text);
  const SweepSetup sweep = read_sweep(folder + "/budget.yaml");
  CampaignOptions own = options;
  own.out = folder;
  const SweepRun run = run_sweep(sweep, own, program, progress);
  if (!run.interrupted && run.worker_exit == 0) runs = runs_of(sweep, folder);
  return run;
}

}  // namespace

BudgetFiles budget_files(const BudgetPlan& plan) {
  const Scenario s = read_scenario(plan.scene);
  if (s.cell.camera_count() > 1) throw SpecError(plan.scene + ": an error budget needs a cell with one camera");
  check_rising(plan.translation, "translation");
  check_rising(plan.rotation, "rotation");
  BudgetFiles files;
  if (plan.stages) files.stages = stages_file(plan, s, files.absent);
  if (!plan.translation.empty() || !plan.rotation.empty()) files.errors = errors_file(plan, s);
  return files;
}

BudgetRunResult run_budget(const BudgetPlan& plan, const CampaignOptions& options, const std::string& program,
                           ProgressSink& progress) {
  const BudgetFiles files = budget_files(plan);
  BudgetRunResult result;
  result.budget.scene = std::filesystem::path(plan.scene).stem().string();
  result.budget.first_seed = plan.first_seed;
  result.budget.end_seed = plan.end_seed;
  result.budget.absent = files.absent;
  const Seed seed = Seed{}.child("error budget");
  std::vector<BudgetRun> runs;
  if (!files.stages.empty()) {
    result.run = run_part(files.stages, options.out + "/stages", options, program, progress, runs);
    if (result.run.interrupted || result.run.worker_exit != 0) return result;
    result.budget.stages = budget_rows(runs, seed);
  }
  if (files.errors.empty()) return result;
  result.run = sum(result.run, run_part(files.errors, options.out + "/errors", options, program, progress, runs));
  if (result.run.interrupted || result.run.worker_exit != 0) return result;
  std::vector<BudgetRun> translation = {runs.front()}, rotation = {runs.front()};
  for (std::size_t k = 0; k < plan.translation.size(); ++k) {
    translation.push_back(runs[1 + k]);
    translation.back().error = plan.translation[k];
  }
  for (std::size_t k = 0; k < plan.rotation.size(); ++k) {
    rotation.push_back(runs[1 + plan.translation.size() + k]);
    rotation.back().error = plan.rotation[k];
  }
  if (translation.size() > 1) result.budget.translation = budget_rows(translation, seed);
  if (rotation.size() > 1) result.budget.rotation = budget_rows(rotation, seed);
  return result;
}

}  // namespace binpick

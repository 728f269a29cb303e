// binpick budget SCENE --seeds A:B --out DIR: what each stage costs, and how large an error of the pose the picks bear
// (docs/budget.md). What is there already is not run again.

#include <iostream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/progress.hpp"
#include "core/quantity.hpp"
#include "tools/commands.hpp"
#include "tools/validate/plot.hpp"
#include "trials/budget.hpp"

namespace binpick {
namespace {

struct Options {
  std::string seeds, json;
  std::vector<std::string> translation = {"0.5 mm", "1 mm", "2 mm", "3 mm", "5 mm", "8 mm"};
  std::vector<std::string> rotation = {"1 deg", "2 deg", "4 deg", "8 deg"};
  BudgetPlan plan;
  CampaignOptions campaign;
  bool no_curves = false, no_stages = false;
};

std::vector<double> read_errors(const std::vector<std::string>& texts, Unit unit) {
  std::vector<double> errors;
  for (const std::string& text : texts) errors.push_back(parse_quantity(text, unit));
  return errors;
}

void draw(const ErrorBudget& budget, const std::string& folder) {
  CurveTable table("curve,error,rate,low,high");
  for (const BudgetRow& row : budget.translation)
    table.add("position",
              {1e3 * row.error, 100 * row.picks.rate, 100 * row.picks.interval.low, 100 * row.picks.interval.high});
  for (const BudgetRow& row : budget.rotation)
    table.add("rotation", {57.29577951308232 * row.error, 100 * row.picks.rate, 100 * row.picks.interval.low,
                           100 * row.picks.interval.high});
  write_plot(folder, "error_curves", table,
             "set xlabel 'error per axis: position in mm, rotation in deg'\nset ylabel 'picks succeeded, %'\n"
             "set yrange [0:102]\nset key bottom left\n"
             "plot file using (curve('position',2)):3:4:5 with yerrorlines lt 1 title 'position, mm', \\\n"
             " file using (curve('rotation',2)):3:4:5 with yerrorlines lt 2 title 'rotation, deg'\n");
  draw_plots(folder, {"error_curves"});
}

int run(Options options) {
  std::tie(options.plan.first_seed, options.plan.end_seed) = parse_seeds(options.seeds);
  if (!options.no_curves) {
    options.plan.translation = read_errors(options.translation, Unit::kLength);
    options.plan.rotation = read_errors(options.rotation, Unit::kAngle);
  }
  options.plan.stages = !options.no_stages;
  const std::string& out = options.campaign.out;
  StderrProgress progress;
  const BudgetRunResult result = run_budget(options.plan, options.campaign, "/proc/self/exe", progress);
  if (result.run.worker_exit != 0) return result.run.worker_exit;
  if (result.run.interrupted) return 130;
  write_file(out + "/budget.md", budget_markdown(result.budget));
  write_file(out + "/budget.csv", budget_csv(result.budget));
  write_file(out + "/budget.json", budget_json(result.budget));
  if (!options.json.empty()) write_file(options.json, budget_json(result.budget));
  if (!options.no_curves) draw(result.budget, out);
  std::cout << budget_text(result.budget) << std::flush;
  return result.run.failed > 0 ? 5 : 0;
}

}  // namespace

Action add_budget(CLI::App& app) {
  auto options = std::make_shared<Options>();
  options->campaign.pictured = -1;
  CLI::App* command = app.add_subcommand("budget", "what each stage costs, and what error of the pose the picks bear");
  command->add_option("scene", options->plan.scene, "scene file (YAML)")->required();
  command->add_option("--seeds", options->seeds, "A:B, the seeds A to B-1 of every row")->required();
  command->add_option("--out", options->campaign.out, "folder for the runs and tables")->required();
  command->add_option("--workers", options->campaign.workers, "worker processes")->check(CLI::Range(1, 256));
  command->add_option("--translation", options->translation, "errors of the position, as in '1 mm', rising");
  command->add_option("--rotation", options->rotation, "errors of the rotation, as in '2 deg', rising");
  command->add_flag("--no-curves", options->no_curves, "no disturbed poses");
  command->add_flag("--no-stages", options->no_stages, "disturbed poses only");
  command->add_option("--json", options->json, "file for the figures (as budget.json in the folder)");
  return [options] { return run(*options); };
}

}  // namespace binpick

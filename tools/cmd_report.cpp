// binpick report RUN...: writes RUN/report.html, tables/, results.md, picks.csv and summary.json from the records,
// prints the table; of several runs one table with a row each; of a sweep's folder the reports of all its cells and its
// own. --replays N: so many replays in the page, run again where the campaign kept none.

#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "evaluation/report.hpp"
#include "tools/commands.hpp"
#include "tools/sweep_picture.hpp"
#include "trials/run_report.hpp"
#include "trials/sweep_run.hpp"

namespace binpick {
namespace {

// The throughput is the campaign's own; a report made later keeps it.
double campaign_wall(const std::string& run_folder) {
  std::ifstream file(run_folder + "/summary.json");
  const nlohmann::json summary = nlohmann::json::parse(file, nullptr, false);
  if (!summary.is_object()) return 0;
  const double per_hour = summary.value("throughput_per_hour", 0.0);
  if (!(per_hour > 0) || !summary.contains("picks") || !summary["picks"].is_object()) return 0;
  return 3600.0 * summary["picks"].value("attempted", 0.0) / per_hour;
}

struct Options {
  std::vector<std::string> folders;
  bool markdown = false;
  int replays = -1;  // not given: those that are kept, up to the default
};

CampaignSummary summary_of(const std::string& folder, const Options& options) {
  if (!std::filesystem::is_directory(folder)) throw SpecError(folder + ": is not a run folder");
  ReportOptions report;
  if (options.replays >= 0) {
    report.replays = static_cast<std::size_t>(options.replays);
    report.run_again = true;
  }
  StderrProgress progress;
  return write_reports(folder, campaign_wall(folder), report, &progress);
}

// Every cell's page, then the sweep's own.
int report_sweep(const Options& options) {
  const std::string& folder = options.folders.front();
  if (options.folders.size() > 1) throw SpecError(folder + ": is a sweep, which is reported alone");
  for (const SweepCellPlan& cell : read_sweep_plan(folder).cells)
    if (const std::string run = folder + "/" + cell.folder; std::filesystem::is_directory(run + "/records"))
      summary_of(run, options);
  const SweepResult result = read_sweep_result(folder);
  write_sweep_files(result, folder);
  std::cout << (options.markdown ? sweep_markdown(result) : sweep_text(result)) << std::flush;
  return 0;
}

}  // namespace

Action add_report(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("report", "tables and a page from a run folder; several: side by side");
  command->add_option("run", options->folders, "run folders, or the folder of a sweep")->required();
  command->add_flag("--markdown", options->markdown, "print the Markdown tables instead of the short one");
  command
      ->add_option("--replays", options->replays,
                   "replays in the page, failed trials first; run again where none is kept (default: up to 20 kept)")
      ->check(CLI::Range(0, 1000));
  return [options] {
    if (is_sweep_folder(options->folders.front())) return report_sweep(*options);
    std::vector<NamedSummary> campaigns;
    for (const std::string& folder : options->folders)
      campaigns.push_back(
          {std::filesystem::path(folder + "/").parent_path().filename().string(), summary_of(folder, *options)});
    const CampaignSummary& first = campaigns.front().summary;
    std::cout << (campaigns.size() > 1 ? side_by_side(campaigns, options->markdown)
                  : options->markdown  ? markdown_report(first)
                                       : terminal_table(first))
              << std::flush;
    return 0;
  };
}

}  // namespace binpick

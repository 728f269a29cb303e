// binpick report RUN: writes RUN/report.html, results.md, picks.csv and summary.json from the records, prints the
// table.

#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "evaluation/report.hpp"
#include "tools/commands.hpp"
#include "trials/campaign.hpp"

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

}  // namespace

Action add_report(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  auto markdown = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("report", "tables and a page from a run folder");
  command->add_option("run", *folder, "run folder")->required();
  command->add_flag("--markdown", *markdown, "print the Markdown tables instead of the short one");
  return [folder, markdown] {
    if (!std::filesystem::is_directory(*folder)) throw SpecError(*folder + ": is not a run folder");
    const CampaignSummary summary = write_reports(*folder, campaign_wall(*folder));
    std::cout << (*markdown ? markdown_report(summary) : terminal_table(summary)) << std::flush;
    return 0;
  };
}

}  // namespace binpick

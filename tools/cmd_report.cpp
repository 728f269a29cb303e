// binpick report RUN...: writes RUN/report.html, results.md, picks.csv and summary.json from the records, prints the
// table; of several runs one table with a row each.

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

CampaignSummary summary_of(const std::string& folder) {
  if (!std::filesystem::is_directory(folder)) throw SpecError(folder + ": is not a run folder");
  return write_reports(folder, campaign_wall(folder));
}

}  // namespace

Action add_report(CLI::App& app) {
  auto folders = std::make_shared<std::vector<std::string>>();
  auto markdown = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("report", "tables and a page from a run folder; several: side by side");
  command->add_option("run", *folders, "run folders")->required();
  command->add_flag("--markdown", *markdown, "print the Markdown tables instead of the short one");
  return [folders, markdown] {
    std::vector<NamedSummary> campaigns;
    for (const std::string& folder : *folders)
      campaigns.push_back({std::filesystem::path(folder + "/").parent_path().filename().string(), summary_of(folder)});
    const CampaignSummary& first = campaigns.front().summary;
    std::cout << (campaigns.size() > 1 ? side_by_side(campaigns, *markdown)
                  : *markdown          ? markdown_report(first)
                                       : terminal_table(first))
              << std::flush;
    return 0;
  };
}

}  // namespace binpick

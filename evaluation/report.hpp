// Tables for people: the only place where millimetres and degrees appear again. Markdown and CSV; one HTML file.
#pragma once

#include <span>
#include <string>

#include "evaluation/summary.hpp"

namespace binpick {

/// The result table of a campaign beside the paper's figures (48/50, Tables 1, 2 and 4).
std::string markdown_report(const CampaignSummary& summary);
/// A short plain-text table for a terminal.
std::string terminal_table(const CampaignSummary& summary);
/// One row per campaign, in the given order: what changed between them (sensors, parts, settings) side by side.
struct NamedSummary {
  std::string name;
  CampaignSummary summary;
};
std::string side_by_side(std::span<const NamedSummary> campaigns, bool markdown);
/// One row per pick.
std::string picks_csv(std::span<const TrialRecord> records);
/// A self-contained page with the tables, the failure list (each line with its replay command) and the run's pictures
/// (paths relative to the run folder).
std::string html_report(const CampaignSummary& summary, std::span<const TrialRecord> records,
                        std::span<const std::string> picture_paths);

}  // namespace binpick

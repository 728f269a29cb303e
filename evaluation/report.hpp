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

/// What a page shows beside the records.
struct PageSources {
  struct Picture {
    std::string caption, png;  ///< bytes
  };
  struct Replay {
    std::uint64_t seed = 0;
    std::string json;  ///< docs/report.md
  };
  std::vector<std::pair<std::string, std::string>> provenance;  ///< what, and its text
  std::vector<Picture> opening;                                 ///< embedded
  std::vector<std::string> picture_paths;                       ///< linked to, relative to the page
  std::string cell_json;                                        ///< of the replays
  std::vector<Replay> replays;
  std::string replay_note;  ///< why some are left out
};

/// One self-contained page: tables, plots, failures with their replay commands, replays. It asks nobody for anything
/// and runs no script but its own, which its content-security policy enforces.
std::string html_report(const CampaignSummary& summary, std::span<const TrialRecord> records,
                        const PageSources& sources);
/// A page with one replay and nothing else.
std::string html_replay(const std::string& title, const PageSources& sources);

}  // namespace binpick

// Numbers and words for the reports: fixed decimals, rates, escaping, outcomes in plain English. Private to this
// folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/pick_outcome.hpp"
#include "evaluation/summary.hpp"

namespace binpick::text {

/// Fixed decimals in the C locale; "-" for what is no number.
std::string fixed(double value, int digits);
/// "96.0 %"; "-" for what is no number.
std::string percent(double share);
/// "86.5 - 98.9 %".
std::string percent(const Interval& interval);
/// "48 / 50".
std::string ratio(const Rate& rate);
/// Three numbers, times `factor`, separated by " / ".
std::string triple(const Eigen::Vector3d& values, double factor, int digits);

/// Safe inside HTML text and quoted attributes. Control characters become spaces.
std::string html(std::string_view raw);
/// Safe inside a Markdown table cell.
std::string markdown(std::string_view raw);
/// A relative path as a URL without scheme or host; empty when the path is absolute or leaves its folder.
std::string relative_url(const std::string& path);

/// What an outcome means, in one phrase.
const char* meaning(PickOutcome outcome);

using Row = std::vector<std::string>;
std::string markdown_table(const Row& head, const std::vector<Row>& rows);
/// Columns padded to their widest cell, two spaces apart, indented by two.
std::string plain_table(const std::vector<Row>& rows);

/// One line of the comparison of stage times (paper Table 4): ours in ms; paper < 0: the paper has no such stage.
struct StageLine {
  std::string name;
  double mean = 0, median = 0, p95 = 0;
  double paper = -1;
};
std::vector<StageLine> stage_lines(const CampaignSummary& summary);

/// One sentence: how the share of cleared parts stands beside the paper's.
std::string verdict(const CampaignSummary& summary);

/// One sentence: executed picks in which arm or tool met bin, tray or table, by the physics world's contacts.
std::string collision_line(const CampaignSummary& summary);

inline constexpr double kToMm = 1e3, kToMs = 1e3, kToDeg = 57.29577951308232;

}  // namespace binpick::text

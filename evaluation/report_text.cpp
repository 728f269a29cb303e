#include "evaluation/report_text.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>

#include "core/hash.hpp"
#include "evaluation/paper_figures.hpp"

namespace binpick::text {

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char buffer[400];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits);
  return std::string(buffer, result.ptr);
}

std::string percent(double share) { return std::isfinite(share) ? fixed(100 * share, 1) + " %" : "-"; }

std::string percent(const Interval& interval) {
  return fixed(100 * interval.low, 1) + " - " + fixed(100 * interval.high, 1) + " %";
}

std::string ratio(const Rate& rate) { return std::to_string(rate.hits) + " / " + std::to_string(rate.total); }

std::string triple(const Eigen::Vector3d& values, double factor, int digits) {
  return fixed(factor * values.x(), digits) + " / " + fixed(factor * values.y(), digits) + " / " +
         fixed(factor * values.z(), digits);
}

std::string html(std::string_view raw) {
  std::string safe;
  for (const char c : raw) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  return safe;
}

std::string markdown(std::string_view raw) {
  std::string safe;
  for (const char c : raw) {
    if (static_cast<unsigned char>(c) < 0x20) {
      safe += ' ';
      continue;
    }
    if (std::string_view("\\`*_[]<>|").find(c) != std::string_view::npos) safe += '\\';
    safe += c;
  }
  return safe;
}

std::string relative_url(const std::string& path) {
  const std::filesystem::path normal = std::filesystem::path(path).lexically_normal();
  if (path.empty() || normal.is_absolute() || *normal.begin() == "..") return "";
  std::string url;
  for (const char c : normal.generic_string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain || std::string_view("-._~/").find(c) != std::string_view::npos) {
      url += c;
    } else {
      url += "%" + hex(static_cast<unsigned char>(c)).substr(14);
    }
  }
  return url;
}

const char* meaning(PickOutcome outcome) {
  switch (outcome) {
    case PickOutcome::kSucceeded:
      return "the part came to rest in the tray";
    case PickOutcome::kBinEmpty:
      return "nothing was left to pick";
    case PickOutcome::kNoDetection:
      return "the estimator found nothing";
    case PickOutcome::kNoReachablePick:
      return "detections, but no pick survived planning";
    case PickOutcome::kPathBlocked:
      return "arm or tool met something on its way";
    case PickOutcome::kNoSeal:
      return "no cup, or too few, sealed on the true surface";
    case PickOutcome::kPulledOff:
      return "normal force or moment beyond the hold";
    case PickOutcome::kSlipped:
      return "shear beyond the hold";
    case PickOutcome::kDroppedInBin:
      return "lost between lift and tray, back into the bin";
    case PickOutcome::kDoublePick:
      return "two parts were lifted";
    case PickOutcome::kLostInTransit:
      return "lost outside bin and tray";
    case PickOutcome::kWrongPlace:
      return "released, but not at rest in the tray";
    case PickOutcome::kProtectiveStop:
      return "the arm stopped to protect itself";
    case PickOutcome::kUnsettled:
      return "the heap never came to rest, or a part fell outside the bin";
    case PickOutcome::kEstimatorFailed:
      return "the estimator failed or ran out of time";
    case PickOutcome::kInternalError:
      return "a bug of the testbed";
  }
  return "";
}

std::vector<StageLine> stage_lines(const CampaignSummary& summary) {
  const auto line = [&](const std::string& name, const char* stage, double paper) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto found = summary.stages.find(stage);
    const StageSummary s = found == summary.stages.end() ? StageSummary{nan, nan, nan} : found->second;
    return StageLine{name, kToMs * s.mean, kToMs * s.median, kToMs * s.p95, paper};
  };
  std::vector<StageLine> lines = {line("pre-processing", "preprocess", paper::kPreprocessMs),
                                  line("PPF voting", "voting", paper::kVotingMs),
                                  line("verification", "verification", -1),
                                  line("ICP", "icp", paper::kIcpMs),
                                  line("estimation, all", "estimate_total", -1),
                                  line("planning", "plan", -1)};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double planning = std::isfinite(lines[5].mean) ? lines[5].mean : 0;
  lines.push_back({"moving robot (simulated)", kToMs * summary.motion_mean, nan, nan, paper::kRobotMs});
  lines.push_back({"total", lines[4].mean + planning + kToMs * summary.motion_mean, nan, nan, paper::kTotalMs});
  return lines;
}

std::string verdict(const CampaignSummary& summary) {
  if (summary.cleared.total == 0) return "Nothing was dropped: there is nothing to judge.";
  // Newcombe 1998, method 10: the interval of a difference of two rates from the interval of each; the paper's fifty
  // parts are as uncertain as ours.
  const double ours = summary.cleared.rate;
  const double theirs = static_cast<double>(paper::kPlaced) / static_cast<double>(paper::kDropped);
  const Interval interval = summary.cleared.interval, paper = wilson_interval(paper::kPlaced, paper::kDropped);
  const bool above = ours - theirs > std::hypot(ours - interval.low, paper.high - theirs);
  const bool below = theirs - ours > std::hypot(interval.high - ours, theirs - paper.low);
  const std::string stand = above ? "above" : below ? "below" : "not distinguishable from";
  return percent(ours) + " of " + std::to_string(summary.cleared.total) + " parts cleared (95 %: " + percent(interval) +
         "), " + stand + " the paper's " + percent(theirs) + ".";
}

std::string collision_line(const CampaignSummary& summary) {
  const CollisionSummary& c = summary.collisions;
  std::string line = "collisions of arm or tool with bin, tray or table: in " + std::to_string(c.collided) + " of " +
                     std::to_string(c.executed) + " executed picks";
  if (c.collided > 0) line += ", at most " + fixed(kToMm * c.depth, 2) + " mm deep";
  if (c.lips > 0) line += "; a lip touched one of them in " + std::to_string(c.lips);
  std::string names;
  for (const auto& [name, count] : c.by_name) names += (names.empty() ? "" : ", ") + name + " " + std::to_string(count);
  return names.empty() ? line : line + " (" + names + ")";
}

std::string markdown_table(const Row& head, const std::vector<Row>& rows) {
  std::string table = "|", rule = "|";
  for (const std::string& cell : head) {
    table += " " + cell + " |";
    rule += " --- |";
  }
  table += "\n" + rule + "\n";
  for (const Row& row : rows) {
    table += "|";
    for (const std::string& cell : row) table += " " + markdown(cell) + " |";
    table += "\n";
  }
  return table + "\n";
}

std::string plain_table(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string table;
  for (const Row& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) line += " " + row[i] + std::string(widths[i] - row[i].size() + 1, ' ');
    table += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return table;
}

}  // namespace binpick::text

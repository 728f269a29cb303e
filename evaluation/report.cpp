#include "evaluation/report.hpp"

#include <algorithm>
#include <cmath>

#include "evaluation/paper_figures.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

using text::fixed;
using text::markdown_table;
using text::plain_table;
using text::Row;

std::string paper_cleared() {
  return std::to_string(paper::kPlaced) + " / " + std::to_string(paper::kDropped) + " = " +
         text::percent(static_cast<double>(paper::kPlaced) / static_cast<double>(paper::kDropped)) + " (Wilson " +
         text::percent(wilson_interval(paper::kPlaced, paper::kDropped)) + ")";
}

Row rate_row(const std::string& name, const Rate& rate, const std::string& paper) {
  return {name, text::ratio(rate), text::percent(rate.rate), text::percent(rate.interval), paper};
}

std::vector<Row> rate_rows(const CampaignSummary& s) {
  return {rate_row("parts cleared (placed / dropped)", s.cleared, paper_cleared()),
          rate_row("picks succeeded / attempted", s.picks, "-"),
          rate_row("recall, every look", s.recall, "-"),
          rate_row("recall, first look", s.recall_first_look, "-"),
          rate_row("recall at 0.05 diameter", s.recall_tight, "-"),
          rate_row("recall at 2 mm", s.recall_2mm, "-"),
          rate_row("precision", s.precision, "-")};
}

std::vector<Row> error_rows(const CampaignSummary& s) {
  const Eigen::Vector3d xyz(paper::kMeanAbsXyzMm[0], paper::kMeanAbsXyzMm[1], paper::kMeanAbsXyzMm[2]);
  const Eigen::Vector3d rpy(paper::kMeanAbsRpyDeg[0], paper::kMeanAbsRpyDeg[1], paper::kMeanAbsRpyDeg[2]);
  return {{"mean absolute error X / Y / Z, mm", text::triple(s.mean_abs_xyz, text::kToMm, 2), text::triple(xyz, 1, 2)},
          {"mean absolute error roll / pitch / yaw, deg", text::triple(s.mean_abs_rpy, text::kToDeg, 2),
           text::triple(rpy, 1, 2)},
          {"translation, median / 95 %, mm",
           fixed(text::kToMm * s.translation_median, 2) + " / " + fixed(text::kToMm * s.translation_p95, 2), "-"},
          {"rotation, median / 95 %, deg",
           fixed(text::kToDeg * s.rotation_median, 2) + " / " + fixed(text::kToDeg * s.rotation_p95, 2), "-"}};
}

std::vector<Row> stage_rows(const CampaignSummary& s) {
  std::vector<Row> rows;
  for (const text::StageLine& line : text::stage_lines(s)) {
    rows.push_back({line.name, fixed(line.mean, 0), fixed(line.median, 0), fixed(line.p95, 0),
                    line.paper < 0 ? "-" : fixed(line.paper, 0)});
  }
  return rows;
}

std::string seed_list(const std::vector<std::uint64_t>& seeds) {
  constexpr std::size_t kShown = 12;
  std::string list;
  for (std::size_t i = 0; i < std::min(seeds.size(), kShown); ++i) list += (i ? ", " : "") + std::to_string(seeds[i]);
  return seeds.size() > kShown ? list + ", and " + std::to_string(seeds.size() - kShown) + " more" : list;
}

std::vector<Row> with_head(const Row& head, std::vector<Row> rows) {
  rows.insert(rows.begin(), head);
  return rows;
}

/// Outcomes that occurred, in the order of the enum, with the seeds that replay them.
std::vector<Row> outcome_rows(const CampaignSummary& s) {
  std::vector<Row> rows;
  for (PickOutcome outcome : all_pick_outcomes()) {
    const auto count = s.outcomes.find(to_string(outcome));
    if (count == s.outcomes.end()) continue;
    const auto seeds = s.outcome_seeds.find(count->first);
    rows.push_back({count->first, std::to_string(count->second), text::meaning(outcome),
                    seeds == s.outcome_seeds.end() ? "" : seed_list(seeds->second)});
  }
  return rows;
}

/// Trials that are no measurement, and those that took a second attempt; empty: there are none.
std::vector<Row> failure_rows(const CampaignSummary& s) {
  std::vector<Row> rows;
  for (const TrialFailure failure : all_trial_failures()) {
    const auto seeds = s.failure_seeds.find(to_string(failure));
    if (seeds == s.failure_seeds.end()) continue;
    rows.push_back({seeds->first, std::to_string(seeds->second.size()), meaning(failure), seed_list(seeds->second)});
  }
  if (!s.repeated_seeds.empty())
    rows.push_back({"second attempt", std::to_string(s.repeated_seeds.size()), "a worker died over them first",
                    seed_list(s.repeated_seeds)});
  return rows;
}

std::string failure_section(const CampaignSummary& s, bool markdown) {
  const std::vector<Row> rows = failure_rows(s);
  const Row head = {"trials that failed: no measurements", "trials", "", "seeds"};
  if (rows.empty()) return "";
  return markdown ? "## Trials that failed\n\nThey are in none of the figures above.\n\n" + markdown_table(head, rows)
                  : plain_table(with_head(head, rows)) + "\n";
}

std::string heap_line(const CampaignSummary& s) {
  return "heaps at rest inside the bin: " + std::to_string(s.heaps.settled) + " of " + std::to_string(s.trials) +
         "; kept awake, " + fixed(100 * s.heaps.moved_share, 1) + " % of their parts moved more than 0.1 mm, at most " +
         fixed(1e3 * s.heaps.largest_motion, 2) + " mm; their true solids enter each other by at most " +
         fixed(1e3 * s.heaps.penetration_max, 2) + " mm";
}

std::string cycle_line(const CampaignSummary& s) {
  return "cycle " + fixed(s.cycle_median, 2) +
         " s simulated (motion, vacuum, exposure): " + fixed(s.simulated_picks_per_hour, 0) +
         " picks per hour; campaign " + (s.throughput_per_hour > 0 ? fixed(s.throughput_per_hour, 0) : "-") +
         " attempts per wall hour";
}

}  // namespace

std::string terminal_table(const CampaignSummary& s) {
  return s.scenario + ", " + std::to_string(s.trials) + " trials. " + text::verdict(s) + "\n\n" +
         plain_table(with_head({"", "count", "rate", "95 %", "paper"}, rate_rows(s))) + "\n" +
         plain_table(with_head({"right poses: " + std::to_string(s.measured), "ours", "paper"}, error_rows(s))) + "\n" +
         plain_table(with_head({"stage, ms", "mean", "median", "p95", "paper"}, stage_rows(s))) + "\n" +
         plain_table(with_head({"outcome", "picks", "", "seeds"}, outcome_rows(s))) + "\n" + failure_section(s, false) +
         "  " + heap_line(s) + "\n  " + text::collision_line(s) + "\n  " + cycle_line(s) + "\n  records " +
         s.records_hash + "\n";
}

std::string markdown_report(const CampaignSummary& s) {
  std::string report =
      "# " + text::markdown(s.scenario) + ": " + std::to_string(s.trials) + " trials\n\n" +
      text::markdown(text::verdict(s)) + "\n\n## Rates\n\n" +
      markdown_table({"", "count", "rate", "95 % interval", "paper"}, rate_rows(s)) +
      "Intervals are cluster bootstraps over piles, because the picks of one pile are not independent; "
      "the paper's is a Wilson interval. A pose is right when its MSSD is below 0.1 diameter; recall "
      "counts instances at least half visible.\n\n## Errors of right poses (paper: Tables 1 and 2)\n\n" +
      markdown_table({std::to_string(s.measured) + " poses", "ours", "paper"}, error_rows(s)) +
      "## Times in ms (paper: Table 4)\n\n" +
      markdown_table({"stage", "mean", "median", "95 %", "paper"}, stage_rows(s)) +
      "Vision and planning are wall times on this machine, robot motion is simulated time.\n\n" +
      text::markdown(cycle_line(s)) + "; " + text::markdown(heap_line(s)) + "; " +
      text::markdown(text::collision_line(s)) + ".\n\n## Outcomes\n\n" +
      markdown_table({"outcome", "picks", "meaning", "seeds"}, outcome_rows(s)) + failure_section(s, true) +
      "Any seed again: `binpick trial scenario.yaml --seed N` in the run folder.\n\n"
      "## The paper's own slips\n\n";
  for (const char* slip : paper::kSlips) report += std::string("- ") + slip + "\n";
  return report + "\nRecords: `" + s.records_hash + "`\n";
}

}  // namespace binpick

// What came out: rates, outcomes, failures, piles, times.
#include "evaluation/report_tables.hpp"

#include <algorithm>
#include <cmath>

#include "evaluation/paper_figures.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

double number(std::size_t value) { return static_cast<double>(value); }

std::string joined(const std::vector<std::uint64_t>& seeds) {
  std::string list;
  for (const std::uint64_t seed : seeds) list += (list.empty() ? "" : " ") + std::to_string(seed);
  return list;
}

ReportTable rates(const CampaignSummary& s) {
  ReportTable table{"rates", "Rates", "Intervals: 95 %, cluster bootstraps over piles; the paper's: Wilson.", {}, {}};
  table.columns = {{"rate", "", -1},
                   {"hits", "hits", 0},
                   {"total", "of", 0},
                   {"share_pct", "share, %", 1},
                   {"low_pct", "95 % from", 1},
                   {"high_pct", "to", 1},
                   {"paper_pct", "paper, %", 1}};
  const auto add = [&](const char* name, const Rate& rate, TableCell paper = {}) {
    table.add({name, number(rate.hits), number(rate.total), 100 * rate.rate, 100 * rate.interval.low,
               100 * rate.interval.high, std::move(paper)});
  };
  add("parts cleared", s.cleared, 100.0 * paper::kPlaced / paper::kDropped);
  add("picks succeeded", s.picks);
  add("recall, every look", s.recall);
  add("recall, first look", s.recall_first_look);
  add("recall at 0.05 diameter", s.recall_tight);
  add("recall at 2 mm", s.recall_2mm);
  add("precision", s.precision);
  return table;
}

ReportTable outcomes(const CampaignSummary& s) {
  ReportTable table{"outcomes", "How picks ended", text::collision_line(s) + ".", {}, {}};
  table.columns = {{"outcome", "outcome", -1},
                   {"picks", "picks", 0},
                   {"share_pct", "share, %", 1},
                   {"meaning", "meaning", -1},
                   {"seeds", "seeds", -1}};
  double all = 0;
  for (const auto& [name, count] : s.outcomes) all += number(count);
  std::vector<std::pair<std::size_t, PickOutcome>> order;
  for (const PickOutcome outcome : all_pick_outcomes())
    if (const auto found = s.outcomes.find(to_string(outcome)); found != s.outcomes.end())
      order.emplace_back(found->second, outcome);
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [count, outcome] : order) {
    const auto seeds = s.outcome_seeds.find(to_string(outcome));
    table.add({to_string(outcome), number(count), 100 * number(count) / all, text::meaning(outcome),
               seeds == s.outcome_seeds.end() ? "" : joined(seeds->second)});
  }
  return table;
}

ReportTable failures(std::span<const TrialRecord> records) {
  ReportTable table{"failures", "Picks that failed", "Commands are for the run folder.", {}, {}};
  table.columns = {{"seed", "seed", -1},
                   {"pick", "pick", 0},
                   {"outcome", "outcome", -1},
                   {"reason", "reason", -1},
                   {"command", "again", -1}};
  for (const TrialRecord& record : records) {
    if (failure_of(record)) continue;
    const std::string seed = std::to_string(record.seed.key);
    for (std::size_t i = 0; i < record.picks.size(); ++i) {
      const PickRecord& pick = record.picks[i];
      if (pick.outcome == PickOutcome::kSucceeded || pick.outcome == PickOutcome::kBinEmpty) continue;
      table.add({seed, number(i), to_string(pick.outcome), pick.reason, "binpick trial scenario.yaml --seed " + seed});
    }
  }
  return table;
}

ReportTable trial_failures(std::span<const TrialRecord> records) {
  ReportTable table{"trial_failures", "Trials that failed: no measurements, in none of the figures", "", {}, {}};
  table.columns = {{"seed", "seed", -1}, {"failure", "failure", -1}, {"error", "error", -1}, {"command", "again", -1}};
  for (const TrialRecord& record : records) {
    const std::string seed = std::to_string(record.seed.key);
    if (const auto failure = failure_of(record))
      table.add({seed, to_string(*failure), record.error, "binpick trial scenario.yaml --seed " + seed});
  }
  return table;
}

ReportTable rejections(std::span<const TrialRecord> records) {
  ReportTable table{"rejections", "What ruled pick candidates out", "", {}, {}};
  table.columns = {{"reason", "reason", -1}, {"candidates", "candidates", 0}};
  std::map<std::string, double> sums;
  for (const TrialRecord& record : records)
    for (const PickRecord& pick : record.picks)
      for (const auto& [reason, count] : pick.rejections) sums[reason] += count;
  std::vector<std::pair<std::string, double>> order(sums.begin(), sums.end());
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  for (const auto& [reason, count] : order) table.add({reason, count});
  return table;
}

/// The paper's Table 3 is the placed column of five such rows.
ReportTable piles(std::span<const TrialRecord> records) {
  ReportTable table{"piles", "Pile by pile (paper: Table 3)", "The paper placed 10, 9, 10, 10 and 9 of 10.", {}, {}};
  table.columns = {{"seed", "seed", -1},         {"dropped", "dropped", 0},     {"placed", "placed", 0},
                   {"attempts", "attempts", 0},  {"succeeded", "succeeded", 0}, {"second_looks", "second looks", 0},
                   {"time_s", "simulated, s", 1}};
  for (const TrialRecord& record : records) {
    if (failure_of(record)) continue;
    double succeeded = 0, looks = 0, time = 0, attempts = 0;
    for (const PickRecord& pick : record.picks) {
      attempts += pick.outcome != PickOutcome::kBinEmpty ? 1 : 0;
      succeeded += pick.outcome == PickOutcome::kSucceeded ? 1 : 0;
      looks += pick.look_time > 0 ? 1 : 0;
      time += pick.sim_time;
    }
    table.add({std::to_string(record.seed.key), double(record.dropped), double(record.placed), attempts, succeeded,
               looks, time});
  }
  return table;
}

ReportTable times(const CampaignSummary& s) {
  ReportTable table{
      "stage_times",
      "Times (paper: Table 4)",
      "Vision and planning are wall times on the machine that ran the campaign, robot motion is simulated "
      "time. Median cycle " +
          text::fixed(s.cycle_median, 2) + " s simulated: " + text::fixed(s.simulated_picks_per_hour, 0) +
          " picks per hour.",
      {},
      {}};
  table.columns = {{"stage", "stage", -1},
                   {"mean_ms", "mean, ms", 0},
                   {"median_ms", "median, ms", 0},
                   {"p95_ms", "95 %, ms", 0},
                   {"paper_ms", "paper, mean, ms", 0}};
  for (const text::StageLine& line : text::stage_lines(s))
    table.add({line.name, line.mean, line.median, line.p95, line.paper < 0 ? TableCell() : TableCell(line.paper)});
  return table;
}

}  // namespace

double GroupCount::hits() const {
  double sum = 0;
  for (const ClusterCount& pile : piles) sum += pile.hits;
  return sum;
}

double GroupCount::total() const {
  double sum = 0;
  for (const ClusterCount& pile : piles) sum += pile.total;
  return sum;
}

std::vector<TableCell> rate_cells(const GroupCount& count, const char* name, std::size_t group) {
  const double total = count.total();
  if (total <= 0) return {{}, {}, {}};
  const Interval interval = cluster_bootstrap(count.piles, Seed{}.child("report").child(name, group), 1000);
  return {100 * count.hits() / total, 100 * interval.low, 100 * interval.high};
}

std::vector<ReportTable> result_tables(const CampaignSummary& summary, std::span<const TrialRecord> records) {
  return {rates(summary),      outcomes(summary), failures(records), trial_failures(records),
          rejections(records), piles(records),    times(summary)};
}

std::vector<ReportTable> report_tables(const CampaignSummary& summary, std::span<const TrialRecord> records) {
  std::vector<ReportTable> all = result_tables(summary, records);
  for (auto* more : {&error_tables, &recall_tables, &emptying_tables})
    for (ReportTable& table : (*more)(records)) all.push_back(std::move(table));
  return all;
}

}  // namespace binpick

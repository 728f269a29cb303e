// Recall against the threshold, by visibility and by depth in the heap; how a bin empties.
#include <algorithm>
#include <cmath>
#include <limits>

#include "evaluation/report_tables.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

constexpr double kVisibleEnough = 0.5;
constexpr double kRight = 0.1;  // diameters

/// One part in the bin at one look.
struct Sighting {
  std::size_t record = 0;
  SeenInstance part;
  std::size_t rank = 0;                                   ///< 0: the highest of the look
  double mssd = std::numeric_limits<double>::infinity();  ///< m, least of the estimates matched to it or nearest to it
  bool found() const { return mssd < kRight * part.diameter; }
};

void add_look(std::size_t record, const PickRecord& pick, std::vector<Sighting>& sightings) {
  std::vector<double> least(pick.seen.size(), std::numeric_limits<double>::infinity());
  for (const MatchedEstimate& e : pick.check.estimates)
    if (e.instance && *e.instance < least.size() && e.error.mssd < least[*e.instance])
      least[*e.instance] = e.error.mssd;
  for (std::size_t i = 0; i < pick.seen.size(); ++i) {
    const double height = pick.seen[i].height;
    const auto higher = std::count_if(pick.seen.begin(), pick.seen.end(),
                                      [&](const SeenInstance& other) { return other.height > height; });
    sightings.push_back({record, pick.seen[i], static_cast<std::size_t>(higher), least[i]});
  }
}

std::vector<Sighting> sightings_of(std::span<const TrialRecord> records) {
  std::vector<Sighting> sightings;
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (failure_of(records[r])) continue;
    for (const PickRecord& pick : records[r].picks) add_look(r, pick, sightings);
  }
  return sightings;
}

template <class Chosen, class Hit>
GroupCount count_of(const std::vector<Sighting>& sightings, std::size_t records, const Chosen& chosen, const Hit& hit) {
  GroupCount count;
  count.piles.resize(records);
  for (const Sighting& s : sightings) {
    if (!chosen(s)) continue;
    count.piles[s.record].total += 1;
    count.piles[s.record].hits += hit(s) ? 1 : 0;
  }
  return count;
}

const auto kFound = [](const Sighting& s) { return s.found(); };
const auto kEnough = [](const Sighting& s) { return s.part.visible >= kVisibleEnough; };

ReportTable by_threshold(const std::vector<Sighting>& sightings, std::size_t records) {
  ReportTable table{
      "recall_by_threshold",
      "Recall against the threshold on MSSD",
      "Instances at least half visible, over every look; an instance is found when an estimate of it lies "
      "below the threshold. In diameters of its part, and in mm.",
      {},
      {}};
  table.columns = {{"threshold_d", "threshold, diameters", 3},
                   {"recall_pct", "recall, %", 1},
                   {"low_pct", "95 % from", 1},
                   {"high_pct", "to", 1},
                   {"threshold_mm", "threshold, mm", 1},
                   {"recall_mm_pct", "recall, %", 1}};
  if (sightings.empty()) return table;
  for (std::size_t k = 0; k <= 20; ++k) {
    const double diameters = 0.01 * double(k), length = 0.5e-3 * double(k);
    const GroupCount relative =
        count_of(sightings, records, kEnough, [&](const Sighting& s) { return s.mssd < diameters * s.part.diameter; });
    const GroupCount absolute =
        count_of(sightings, records, kEnough, [&](const Sighting& s) { return s.mssd < length; });
    const std::vector<TableCell> rate = rate_cells(relative, "threshold", k);
    const double share = 100 * absolute.hits() / absolute.total();
    table.add({diameters, rate[0], rate[1], rate[2], text::kToMm * length, share});
  }
  return table;
}

ReportTable by_visibility(const std::vector<Sighting>& sightings, std::size_t records) {
  ReportTable table{"recall_by_visibility", "Recall by visible fraction", "At 0.1 diameter, over every look.", {}, {}};
  table.columns = {{"visible_from_pct", "visible from, %", 0},
                   {"visible_to_pct", "to, %", 0},
                   {"instances", "instances", 0},
                   {"found", "found", 0},
                   {"recall_pct", "recall, %", 1},
                   {"low_pct", "95 % from", 1},
                   {"high_pct", "to", 1}};
  if (sightings.empty()) return table;
  for (std::size_t b = 0; b < 10; ++b) {
    const auto bin = [&](const Sighting& s) { return std::min<std::size_t>(9, std::size_t(10 * s.part.visible)) == b; };
    const GroupCount count = count_of(sightings, records, bin, kFound);
    const std::vector<TableCell> rate = rate_cells(count, "visibility", b);
    table.add({10.0 * double(b), 10.0 * double(b + 1), count.total(), count.hits(), rate[0], rate[1], rate[2]});
  }
  return table;
}

ReportTable by_rank(const std::vector<Sighting>& sightings, std::size_t records) {
  ReportTable table{
      "recall_by_rank",
      "Recall by rank in the heap",
      "Rank 1 is the part whose middle lies highest at the look; from rank 12 on together. At 0.1 diameter; "
      "all instances, and those at least half visible.",
      {},
      {}};
  table.columns = {{"rank", "rank from above", 0}, {"instances", "instances", 0},
                   {"found", "found", 0},          {"recall_pct", "recall, %", 1},
                   {"low_pct", "95 % from", 1},    {"high_pct", "to", 1},
                   {"visible", "half visible", 0}, {"recall_visible_pct", "recall of those, %", 1}};
  constexpr std::size_t kLast = 11;
  for (std::size_t k = 0; k <= kLast; ++k) {
    const auto ranked = [&](const Sighting& s) { return std::min(s.rank, kLast) == k; };
    const GroupCount count = count_of(sightings, records, ranked, kFound);
    if (count.total() == 0) continue;
    const GroupCount visible = count_of(
        sightings, records, [&](const Sighting& s) { return ranked(s) && kEnough(s); }, kFound);
    const std::vector<TableCell> rate = rate_cells(count, "rank", k);
    table.add({double(k + 1), count.total(), count.hits(), rate[0], rate[1], rate[2], visible.total(),
               100 * visible.hits() / visible.total()});
  }
  return table;
}

/// Parts in the bin before each attempt: what was dropped into it less what has left it, as far as the record tells.
std::vector<double> left_before(const TrialRecord& record) {
  std::vector<double> left;
  double now = record.dropped - record.escaped;
  for (const PickRecord& pick : record.picks) {
    left.push_back(pick.seen.empty() ? now : double(pick.seen.size()));
    now = left.back() - (pick.outcome == PickOutcome::kSucceeded ? 1 : 0) - pick.parts_lost;
  }
  left.push_back(std::max(0.0, now));
  return left;
}

ReportTable emptying(std::span<const TrialRecord> records) {
  ReportTable table{
      "emptying",
      "How a bin empties",
      "Parts left in the bin after so many attempts, over all piles; a pile that is done keeps what is left.",
      {},
      {}};
  table.columns = {{"attempts", "attempts", 0}, {"left_mean", "parts left, mean", 2},
                   {"left_p10", "10 %", 1},     {"left_median", "median", 1},
                   {"left_p90", "90 %", 1},     {"piles_busy", "piles still busy", 0}};
  std::vector<std::vector<double>> curves;
  std::size_t longest = 0;
  for (const TrialRecord& record : records) {
    if (failure_of(record) || record.picks.empty()) continue;
    curves.push_back(left_before(record));
    longest = std::max(longest, curves.back().size());
  }
  for (std::size_t k = 0; k < longest; ++k) {
    std::vector<double> left;
    double busy = 0;
    for (const std::vector<double>& curve : curves) {
      left.push_back(curve[std::min(k, curve.size() - 1)]);
      busy += k + 1 < curve.size() ? 1 : 0;
    }
    table.add({double(k), mean(left), quantile(left, 0.1), quantile(left, 0.5), quantile(left, 0.9), busy});
  }
  return table;
}

ReportTable by_parts_left(std::span<const TrialRecord> records) {
  ReportTable table{"picks_by_parts_left",
                    "Picks by parts left in the bin",
                    "Cycle: simulated motion, vacuum and exposure of an attempt, whatever ended it.",
                    {},
                    {}};
  table.columns = {
      {"parts_left", "parts left", 0},           {"attempts", "attempts", 0},  {"succeeded", "succeeded", 0},
      {"success_pct", "success, %", 1},          {"low_pct", "95 % from", 1},  {"high_pct", "to", 1},
      {"cycle_median_s", "cycle, median, s", 2}, {"cycle_p95_s", "95 %, s", 2}};
  std::map<std::size_t, GroupCount> counts;
  std::map<std::size_t, std::vector<double>> cycles;
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (failure_of(records[r])) continue;
    const std::vector<double> left = left_before(records[r]);
    for (std::size_t i = 0; i < records[r].picks.size(); ++i) {
      const PickRecord& pick = records[r].picks[i];
      if (pick.outcome == PickOutcome::kBinEmpty) continue;
      const auto key = static_cast<std::size_t>(std::max(0.0, left[i]));
      counts[key].piles.resize(records.size());
      counts[key].piles[r].total += 1;
      counts[key].piles[r].hits += pick.outcome == PickOutcome::kSucceeded ? 1 : 0;
      cycles[key].push_back(pick.sim_time);
    }
  }
  for (const auto& [left, count] : counts) {
    const std::vector<TableCell> rate = rate_cells(count, "parts left", left);
    table.add({double(left), count.total(), count.hits(), rate[0], rate[1], rate[2], quantile(cycles[left], 0.5),
               quantile(cycles[left], 0.95)});
  }
  return table;
}

}  // namespace

std::vector<ReportTable> recall_tables(std::span<const TrialRecord> records) {
  const std::vector<Sighting> sightings = sightings_of(records);
  return {by_threshold(sightings, records.size()), by_visibility(sightings, records.size()),
          by_rank(sightings, records.size())};
}

std::vector<ReportTable> emptying_tables(std::span<const TrialRecord> records) {
  return {emptying(records), by_parts_left(records)};
}

}  // namespace binpick

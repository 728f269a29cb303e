// One self-contained page. Every text that comes from a file is escaped; nothing is fetched from anywhere but the run
// folder's own pictures, which the Content-Security-Policy enforces.
#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "evaluation/html_plots.hpp"
#include "evaluation/html_style.hpp"
#include "evaluation/paper_figures.hpp"
#include "evaluation/report.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

using text::fixed;

constexpr std::size_t kFailuresShown = 500;

std::string cell(const std::string& raw, const char* kind = "") {
  return std::string("<td") + (*kind ? std::string(" class=\"") + kind + "\"" : "") + ">" + text::html(raw) + "</td>";
}

std::string head(const std::vector<std::pair<const char*, const char*>>& columns) {
  std::string row = "<tr>";
  for (const auto& [name, kind] : columns)
    row += std::string("<th class=\"") + kind + "\">" + text::html(name) + "</th>";
  return row + "</tr>";
}

std::string table(const std::string& rows) { return "<div class=\"scroll\"><table>" + rows + "</table></div>"; }

std::string card(const char* name, const Rate& rate, double reference = -1) {
  return std::string("<div class=\"card\"><span>") + name + "</span><b>" + text::percent(rate.rate) + "</b>" +
         html::rate_track(rate, reference) + "<span>" + text::ratio(rate) + ", 95 %: " + text::percent(rate.interval) +
         "</span></div>";
}

std::string cards(const CampaignSummary& s) {
  const double paper_rate = static_cast<double>(paper::kPlaced) / static_cast<double>(paper::kDropped);
  const Interval theirs = wilson_interval(paper::kPlaced, paper::kDropped);
  return "<div class=\"cards\">" + card("parts cleared", s.cleared, paper_rate) + card("picks succeeded", s.picks) +
         card("recall, every look", s.recall) + card("recall, first look", s.recall_first_look) +
         card("recall at 0.05 diameter", s.recall_tight) + card("recall at 2 mm", s.recall_2mm) +
         card("precision", s.precision) + "</div><p class=\"note\">The tick marks the paper's " +
         std::to_string(paper::kPlaced) + " / " + std::to_string(paper::kDropped) + " = " + text::percent(paper_rate) +
         " (Wilson 95 %: " + text::percent(theirs) +
         "). Our intervals are cluster bootstraps over piles. A pose is right when its largest surface distance (MSSD) "
         "is "
         "below 0.1 diameter; recall counts instances at least half visible.</p>";
}

std::string error_table(const CampaignSummary& s) {
  const auto three = [](const std::array<double, 3>& v) { return text::triple({v[0], v[1], v[2]}, 1, 2); };
  const auto row = [](const std::string& name, const std::string& ours, const std::string& theirs) {
    return "<tr>" + cell(name) + cell(ours, "n") + cell(theirs, "n") + "</tr>";
  };
  const auto pair = [](double median, double p95) { return fixed(median, 2) + " / " + fixed(p95, 2); };
  return table(
      head({{"right poses", ""}, {"ours", "n"}, {"paper", "n"}}) +
      row("mean absolute X / Y / Z, mm", text::triple(s.mean_abs_xyz, text::kToMm, 2), three(paper::kMeanAbsXyzMm)) +
      row("mean absolute roll / pitch / yaw, deg", text::triple(s.mean_abs_rpy, text::kToDeg, 2),
          three(paper::kMeanAbsRpyDeg)) +
      row("translation, median / 95 %, mm", pair(text::kToMm * s.translation_median, text::kToMm * s.translation_p95),
          "-") +
      row("rotation, median / 95 %, deg", pair(text::kToDeg * s.rotation_median, text::kToDeg * s.rotation_p95), "-"));
}

std::string error_plots(std::span<const TrialRecord> records) {
  std::vector<double> translations, rotations;
  for (const TrialRecord& record : records) {
    for (const PickRecord& pick : record.picks) {
      for (const MatchedEstimate& e : pick.check.estimates) {
        if (!e.right || e.ignored || !std::isfinite(e.error.translation) || !std::isfinite(e.error.rotation)) continue;
        translations.push_back(text::kToMm * e.error.translation);
        rotations.push_back(text::kToDeg * e.error.rotation);
      }
    }
  }
  std::string plots;
  for (const std::string& plot : {html::distribution("translation error", "mm", translations),
                                  html::distribution("rotation error", "deg", rotations)}) {
    if (!plot.empty()) plots += "<div class=\"card\">" + plot + "</div>";
  }
  return "<div class=\"plots\">" + plots + "</div>";
}

std::string stage_table(const CampaignSummary& s) {
  std::string rows = head({{"stage, ms", ""}, {"mean", "n"}, {"median", "n"}, {"95 %", "n"}, {"paper, mean", "n"}});
  for (const text::StageLine& line : text::stage_lines(s)) {
    rows += "<tr>" + cell(line.name) + cell(fixed(line.mean, 0), "n") + cell(fixed(line.median, 0), "n") +
            cell(fixed(line.p95, 0), "n") + cell(line.paper < 0 ? "-" : fixed(line.paper, 0), "n") + "</tr>";
  }
  return table(rows) +
         "<p class=\"note\">Vision and planning are wall times on the machine that ran the campaign, robot "
         "motion is simulated time. Median cycle " +
         fixed(s.cycle_median, 2) + " s simulated: " + fixed(s.simulated_picks_per_hour, 0) + " picks per hour.</p>";
}

std::string outcome_table(const CampaignSummary& s) {
  std::size_t most = 1;
  for (const auto& [name, count] : s.outcomes) most = std::max(most, count);
  std::string rows = head({{"outcome", ""}, {"picks", "n"}, {"", "wide"}, {"meaning", ""}});
  for (PickOutcome outcome : all_pick_outcomes()) {
    const auto found = s.outcomes.find(to_string(outcome));
    if (found == s.outcomes.end()) continue;
    const double share = 100.0 * static_cast<double>(found->second) / static_cast<double>(most);
    const bool good = outcome == PickOutcome::kSucceeded || outcome == PickOutcome::kBinEmpty;
    rows += "<tr>" + cell(found->first) + cell(std::to_string(found->second), "n") +
            "<td class=\"wide\"><div class=\"bar" + (good ? " ok" : "") + "\" style=\"width:" + fixed(share, 1) +
            "%\"></div></td>" + cell(text::meaning(outcome)) + "</tr>";
  }
  return table(rows);
}

/// What ruled candidates out, over all picks, most frequent first.
std::string rejection_table(std::span<const TrialRecord> records) {
  std::map<std::string, long> sums;
  for (const TrialRecord& record : records) {
    for (const PickRecord& pick : record.picks) {
      for (const auto& [reason, count] : pick.rejections) sums[reason] += count;
    }
  }
  if (sums.empty()) return "";
  std::vector<std::pair<std::string, long>> sorted(sums.begin(), sums.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  constexpr std::size_t kShown = 12;
  std::string rows = head({{"reason", ""}, {"candidates", "n"}});
  for (std::size_t i = 0; i < std::min(sorted.size(), kShown); ++i) {
    rows += "<tr>" + cell(sorted[i].first) + cell(std::to_string(sorted[i].second), "n") + "</tr>";
  }
  return "<h2>What ruled pick candidates out</h2>" + table(rows);
}

/// "seed-9" before "seed-10".
struct ShorterFirst {
  bool operator()(const std::string& a, const std::string& b) const {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  }
};
using Pictures = std::map<std::string, std::vector<std::string>, ShorterFirst>;

/// Pictures by the folder they lie in, in the given order within it. Paths that leave the run folder are left out.
Pictures by_folder(std::span<const std::string> picture_paths) {
  Pictures folders;
  for (const std::string& path : picture_paths) {
    if (text::relative_url(path).empty()) continue;
    const std::size_t slash = path.find_last_of('/');
    folders[slash == std::string::npos ? "" : path.substr(0, slash)].push_back(path);
  }
  return folders;
}

std::string failure_row(const TrialRecord& record, std::size_t index, bool pictured) {
  const PickRecord& pick = record.picks[index];
  const std::string seed = std::to_string(record.seed.key);
  return "<tr><td class=\"n\">" + (pictured ? "<a href=\"#seed-" + seed + "\">" + seed + "</a>" : seed) + "</td>" +
         cell(std::to_string(index), "n") + cell(to_string(pick.outcome)) + cell(pick.reason) +
         "<td><code>binpick trial scenario.yaml --seed " + seed + "</code></td></tr>";
}

std::string failed_trial_row(const TrialRecord& record) {
  const std::string seed = std::to_string(record.seed.key);
  return "<tr>" + cell(seed, "n") + cell("-", "n") + cell(to_string(*failure_of(record))) + cell(record.error) +
         "<td><code>binpick trial scenario.yaml --seed " + seed + "</code></td></tr>";
}

std::string failure_list(std::span<const TrialRecord> records, const Pictures& pictures) {
  std::string rows =
      head({{"seed", "n"}, {"pick", "n"}, {"outcome", ""}, {"reason", ""}, {"again, in the run folder", ""}});
  std::size_t count = 0;
  for (const TrialRecord& record : records)
    if (failure_of(record) && ++count <= kFailuresShown) rows += failed_trial_row(record);
  for (const TrialRecord& record : records) {
    if (failure_of(record)) continue;
    for (std::size_t i = 0; i < record.picks.size(); ++i) {
      const PickOutcome outcome = record.picks[i].outcome;
      if (outcome == PickOutcome::kSucceeded || outcome == PickOutcome::kBinEmpty) continue;
      if (++count > kFailuresShown) continue;
      rows += failure_row(record, i, pictures.count("artifacts/seed-" + std::to_string(record.seed.key)) > 0);
    }
  }
  if (count == 0) return "<p>None.</p>";
  if (count <= kFailuresShown) return table(rows);
  return table(rows) + "<p class=\"note\">The first " + std::to_string(kFailuresShown) + " of " +
         std::to_string(count) + "; picks.csv has them all.</p>";
}

std::string figure(const std::string& path, const std::string& raw_caption) {
  const std::string url = text::html(text::relative_url(path)), caption = text::html(raw_caption);
  return "<figure><a href=\"" + url + "\"><img loading=\"lazy\" src=\"" + url + "\" alt=\"" + caption +
         "\"></a><figcaption>" + caption + "</figcaption></figure>";
}

/// The first heap and the first estimates drawn over it, large.
std::string opening_pictures(const Pictures& pictures) {
  const auto first = [&](std::string_view ending) -> std::string {
    for (const auto& [folder, paths] : pictures) {
      for (const std::string& path : paths) {
        if (path.ends_with(ending)) return path;
      }
    }
    return "";
  };
  const std::string heap = first("heap.png"), estimates = first("estimates.png");
  if (heap.empty() || estimates.empty()) return "";
  return "<div class=\"plots opening\">" + figure(heap, "the heap") +
         figure(estimates, "estimates over the camera's view") + "</div>";
}

std::string gallery(const Pictures& pictures) {
  std::string section;
  for (const auto& [folder, paths] : pictures) {
    const std::size_t slash = folder.find_last_of('/');
    const std::string name = slash == std::string::npos ? folder : folder.substr(slash + 1);
    section += "<h3 id=\"" + text::html(name) + "\">" + text::html(name) + "</h3><div class=\"pictures\">";
    for (const std::string& path : paths) {
      section += figure(path, path.substr(folder.empty() ? 0 : folder.size() + 1));
    }
    section += "</div>";
  }
  return section.empty() ? "" : "<h2>Pictures</h2>" + section;
}

std::string slips() {
  std::string list = "<ul class=\"note\">";
  for (const char* slip : paper::kSlips) list += "<li>" + text::html(slip) + "</li>";
  return list + "</ul>";
}

}  // namespace

std::string html_report(const CampaignSummary& summary, std::span<const TrialRecord> records,
                        std::span<const std::string> picture_paths) {
  const auto pictures = by_folder(picture_paths);
  const std::string name = text::html(summary.scenario);
  const std::string scenario_hash = records.empty() ? "-" : text::html(records.front().scenario_hash);
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
         "img-src 'self' file:; base-uri 'none'; form-action 'none'\">"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
         name + " - binpick</title><style>" + html::kStyle + "</style></head><body><main><h1>" + name +
         "</h1><p class=\"verdict\">" + text::html(text::verdict(summary)) + "</p>" + opening_pictures(pictures) +
         cards(summary) + "<h2>Errors of right poses (paper: Tables 1 and 2)</h2>" + error_table(summary) + "<p></p>" +
         error_plots(records) + "<h2>Times (paper: Table 4)</h2>" + stage_table(summary) + "<h2>How picks ended</h2>" +
         outcome_table(summary) + "<p class=\"note\">" + text::html(text::collision_line(summary)) +
         ".</p><h2>Failures</h2>" + failure_list(records, pictures) + rejection_table(records) + gallery(pictures) +
         "<h2>About the paper's figures</h2>" + slips() + "<p class=\"note\">" + std::to_string(summary.trials) +
         " trials; scenario " + scenario_hash + "; records " + text::html(summary.records_hash) +
         ".</p></main></body></html>\n";
}

}  // namespace binpick

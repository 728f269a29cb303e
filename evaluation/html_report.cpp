// The report's body. Every text that comes from a file is escaped; what the plots show also stands in tables, for those
// who cannot see them or run no scripts.
#include <algorithm>
#include <map>

#include "evaluation/html_page.hpp"
#include "evaluation/html_plots.hpp"
#include "evaluation/paper_figures.hpp"
#include "evaluation/report_tables.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

using Tables = std::vector<ReportTable>;

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
         "is below 0.1 diameter; recall counts instances at least half visible.</p>";
}

std::string opening(const PageSources& sources) {
  if (sources.opening.empty()) return "";
  return "<div class=\"plots opening\">" + html::figures(sources.opening) + "</div>";
}

const ReportTable& table_of(const Tables& tables, const std::string& id) {
  return *std::find_if(tables.begin(), tables.end(), [&](const ReportTable& table) { return table.id == id; });
}

/// A table to unfold.
std::string folded(const ReportTable& table, bool open = false) {
  if (table.rows.empty()) return "";
  return "<details id=\"table-" + table.id + "\"" + (open ? " open" : "") + "><summary>" + text::html(table.title) +
         "</summary>" + table_html(table) +
         (table.note.empty() ? "" : "<p class=\"note\">" + text::html(table.note) + "</p>") + "</details>";
}

/// The place of a plot. `what` is read where it cannot be seen.
std::string plot(const char* id, const char* what) {
  return std::string("<div class=\"card plot\"><div class=\"canvas\"><canvas id=\"plot-") + id +
         "\" role=\"img\" aria-label=\"" + what + "\"></canvas></div></div>";
}

std::string section(const char* id, const char* title, const std::string& body) {
  return std::string("<section id=\"") + id + "\"><h2>" + title + "</h2>" + body + "</section>";
}

std::string failures_section(const Tables& tables) {
  const ReportTable& failures = table_of(tables, "failures");
  const ReportTable& broken = table_of(tables, "trial_failures");
  std::string body = failures.rows.empty() ? "<p>No pick failed.</p>"
                                           : plot("pareto", "Failed picks by outcome, most frequent first") +
                                                 "<div id=\"outcomes\" class=\"chips\"></div>"
                                                 "<div id=\"drill\" aria-live=\"polite\"></div>";
  return section("failures", "Failures",
                 body + folded(failures) + folded(broken, true) + folded(table_of(tables, "outcomes"), true) +
                     folded(table_of(tables, "rejections")));
}

std::string recall_section(const Tables& tables) {
  if (table_of(tables, "recall_by_threshold").rows.empty())
    return section("recall", "Recall",
                   "<p class=\"note\">These records do not say what lay in the bin at each look (they are of an older "
                   "version): no recall by threshold, visibility or rank.</p>");
  return section("recall", "Recall",
                 "<div class=\"plots\">" + plot("threshold", "Recall against the threshold in diameters") +
                     plot("threshold-mm", "Recall against the threshold in mm") +
                     plot("visibility", "Recall by visible fraction") + plot("rank", "Recall by rank in the heap") +
                     "</div>" + folded(table_of(tables, "recall_by_threshold")) +
                     folded(table_of(tables, "recall_by_visibility")) + folded(table_of(tables, "recall_by_rank")));
}

std::string errors_section(const Tables& tables) {
  std::string plots;
  if (!table_of(tables, "error_cdf").rows.empty())
    plots = "<div class=\"plots\">" + plot("translation", "Distribution of translation errors") +
            plot("rotation", "Distribution of rotation errors") +
            plot("axes", "Mean absolute error by axis, ours and the paper's") +
            plot("score", "Share of right estimates by score") + "</div>";
  return section("errors", "Errors of right poses",
                 plots + folded(table_of(tables, "errors_by_axis"), true) + folded(table_of(tables, "error_cdf")) +
                     folded(table_of(tables, "score_calibration")));
}

std::string slips() {
  std::string list = "<ul class=\"note\">";
  for (const char* slip : paper::kSlips) list += "<li>" + text::html(slip) + "</li>";
  return list + "</ul>";
}

std::string provenance(const CampaignSummary& summary, std::span<const TrialRecord> records,
                       const PageSources& sources) {
  std::vector<std::pair<std::string, std::string>> rows;
  if (!records.empty()) {
    rows.emplace_back("scenario hash", records.front().scenario_hash);
    rows.emplace_back("seeds", std::to_string(records.front().seed.key) + " to " +
                                   std::to_string(records.back().seed.key) + ", " + std::to_string(records.size()) +
                                   " trials");
    rows.emplace_back("build of the program", records.front().build.empty() ? "not recorded" : records.front().build);
    rows.emplace_back("record schema", std::to_string(records.front().schema));
  }
  rows.emplace_back("records hash", summary.records_hash);
  rows.insert(rows.end(), sources.provenance.begin(), sources.provenance.end());
  std::string html = "<div class=\"scroll\"><table>";
  for (const auto& [what, value] : rows)
    html += "<tr><th scope=\"row\">" + text::html(what) + "</th><td><code>" + text::html(value) + "</code></td></tr>";
  return section("provenance", "Provenance", html + "</table></div>");
}

/// Links to the run folder's pictures, by seed: "seed-9" before "seed-10". Paths that leave the folder are left out.
std::string picture_links(const PageSources& sources) {
  std::map<std::pair<std::size_t, std::string>, std::string> folders;
  for (const std::string& path : sources.picture_paths) {
    const std::string url = text::html(text::relative_url(path));
    if (url.empty()) continue;
    const std::size_t slash = path.find_last_of('/');
    const std::string folder = slash == std::string::npos ? "" : path.substr(0, slash);
    folders[{folder.size(), folder}] += "<a href=\"" + url + "\">" + text::html(path.substr(slash + 1)) + "</a> ";
  }
  if (folders.empty()) return "";
  std::string rows;
  for (const auto& [folder, links] : folders)
    rows += "<tr><th scope=\"row\">" + text::html(folder.second) + "</th><td>" + links + "</td></tr>";
  return section("pictures", "Pictures in the run folder",
                 "<details><summary>" + std::to_string(sources.picture_paths.size()) +
                     " pictures</summary><div class=\"scroll\"><table>" + rows + "</table></div></details>");
}

}  // namespace

std::string html_report(const CampaignSummary& summary, std::span<const TrialRecord> records,
                        const PageSources& sources) {
  const Tables tables = report_tables(summary, records);
  const std::string replays = html::replay_section(sources);
  const auto folds = [&](const char* id) { return folded(table_of(tables, id)); };
  html::Page page{summary.scenario, "", tables_json(tables), &sources};
  page.body = "<h1>" + text::html(summary.scenario) + "</h1><p class=\"verdict\">" +
              text::html(text::verdict(summary)) + "</p><nav><a href=\"#failures\">failures</a>" +
              (replays.empty() ? "" : "<a href=\"#replay\">replay</a>") +
              "<a href=\"#recall\">recall</a><a href=\"#errors\">errors</a><a href=\"#times\">times</a>"
              "<a href=\"#emptying\">emptying</a><a href=\"#provenance\">provenance</a></nav>" +
              cards(summary) + folds("rates") + opening(sources) + failures_section(tables) + replays +
              recall_section(tables) + errors_section(tables) +
              section("times", "Times",
                      plot("times", "Mean time of a cycle by stage, ours and the paper's") +
                          folded(table_of(tables, "stage_times"), true)) +
              section("emptying", "How a bin empties",
                      "<div class=\"plots\">" + plot("emptying", "Parts left in the bin against attempts") +
                          plot("left", "Success and cycle time by parts left") + "</div>" + folds("emptying") +
                          folds("picks_by_parts_left") + folds("piles")) +
              provenance(summary, records, sources) + picture_links(sources) +
              section("paper", "About the paper's figures", slips());
  return html::whole_page(page);
}

std::string html_replay(const std::string& title, const PageSources& sources) {
  html::Page page{title, "", "", &sources};
  page.body = "<h1>" + text::html(title) + "</h1>" + html::replay_section(sources);
  return html::whole_page(page);
}

}  // namespace binpick

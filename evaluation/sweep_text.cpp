// A sweep for people: one sentence, the factors' levels, the cells from the best down. Text, Markdown and CSV.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "evaluation/report_text.hpp"
#include "evaluation/sweep_figures.hpp"

namespace binpick {

std::string cell_label(const SweepCellPlan& cell) {
  std::string label;
  for (const std::string& value : cell.values) label += (label.empty() ? "" : ", ") + value;
  return label;
}

namespace {

using text::fixed;
using text::Row;

const char* objective_name(const SweepPlan& plan) {
  return plan.objective == "picks" ? "picks succeeded" : "parts cleared";
}

const Rate& objective(const SweepPlan& plan, const Rate& cleared, const Rate& picks) {
  return plan.objective == "picks" ? picks : cleared;
}

std::string share(const Rate& rate) {
  return std::isnan(rate.rate) ? "-" : text::percent(rate.rate) + " (" + text::percent(rate.interval) + ")";
}

std::string points(double value) { return (value > 0 ? "+" : "") + fixed(100 * value, 1); }

std::string points(const std::optional<SweepDifference>& d) {
  if (!d) return "-";
  return points(d->value) + " (" + points(d->interval.low) + " to " + points(d->interval.high) + ")";
}

std::string p_value(const std::optional<SweepDifference>& d) {
  if (!d) return "-";
  if (d->p_holm >= 1e-3) return fixed(d->p_holm, 3);
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, d->p_holm, std::chars_format::scientific, 0).ptr;
  return std::string(buffer, end);
}

std::string finding(bool best, const std::optional<SweepDifference>& d) {
  return best ? "best" : !d ? "-" : d->worse ? "worse" : "not told from the best";
}

Row factor_head() { return {"factor", "level", "cells", "cleared", "picks", "to the best, points", "p (Holm)", ""}; }

std::vector<Row> factor_rows(const SweepResult& result) {
  std::vector<Row> rows;
  for (std::size_t f = 0; f < result.factors.size(); ++f)
    for (std::size_t l = 0; l < result.factors[f].levels.size(); ++l) {
      const SweepLevel& level = result.factors[f].levels[l];
      rows.push_back({l == 0 ? result.plan.factors[f].name : "", result.plan.factors[f].levels[l],
                      std::to_string(level.cells), share(level.cleared), share(level.picks), points(level.difference),
                      p_value(level.difference), finding(result.factors[f].best == l, level.difference)});
    }
  return rows;
}

/// From the best down; what has no records last.
std::vector<std::size_t> ranked(const SweepResult& result) {
  std::vector<std::size_t> order(result.cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rate = [&](std::size_t c) {
    const CampaignSummary& s = result.cells[c].summary;
    const double r = objective(result.plan, s.cleared, s.picks).rate;
    return result.best == c ? 2 : std::isnan(r) ? -1 : r;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rate(a) > rate(b); });
  return order;
}

Row cell_head(const SweepPlan& plan) {
  Row head;
  for (const SweepFactorPlan& factor : plan.factors) head.push_back(factor.name);
  for (const char* name : {"piles", "cleared", "picks", "first look found", "translation 95 %, mm", "cycle, s",
                           "to the best, points", "p (Holm)", ""})
    head.push_back(name);
  return head;
}

std::vector<Row> cell_rows(const SweepResult& result) {
  std::vector<Row> rows;
  for (const std::size_t c : ranked(result)) {
    const SweepCell& cell = result.cells[c];
    const CampaignSummary& s = cell.summary;
    Row row = result.plan.cells[c].values;
    for (const std::string& text :
         {std::to_string(s.trials - s.failed), share(s.cleared), share(s.picks),
          text::percent(s.recall_first_look.rate), fixed(text::kToMm * s.translation_p95, 2), fixed(s.cycle_median, 2),
          points(cell.difference), p_value(cell.difference), finding(result.best == c, cell.difference)})
      row.push_back(text);
    rows.push_back(row);
  }
  return rows;
}

std::string sentence(const SweepResult& result) {
  if (!result.best) return "Nothing has been run yet.";
  const SweepCell& best = result.cells[*result.best];
  const std::size_t others = result.cells.size() - 1, alike = not_worse(result).size() - 1;
  std::size_t worse = 0;
  for (const SweepCell& cell : result.cells) worse += cell.difference && cell.difference->worse ? 1 : 0;
  std::string text = "Best cell: " + cell_label(result.plan.cells[*result.best]) + " with " +
                     share(objective(result.plan, best.summary.cleared, best.summary.picks)) + " " +
                     objective_name(result.plan) + ". Of the other " + std::to_string(others) + " cells " +
                     std::to_string(alike) + " cannot be told from it and " + std::to_string(worse) + " are worse";
  if (alike + worse < others) text += "; " + std::to_string(others - alike - worse) + " share no pile with it";
  return text + ".";
}

std::vector<std::string> notes(const SweepResult& result) {
  const SweepPlan& plan = result.plan;
  std::vector<std::string> notes = {
      "seeds " + std::to_string(plan.first_seed) + " to " + std::to_string(plan.end_seed - 1) +
          " in every cell; intervals are 95 %, by resampling whole seeds; differences are in " + objective_name(plan) +
          ", seed by seed",
      "worse: p <= " + fixed(plan.alpha, 3) +
          " after Holm over every comparison between two cells (or two levels of a factor), since the best was chosen "
          "by the same data"};
  std::size_t failed = 0, missing = 0;
  for (const SweepCell& cell : result.cells) {
    failed += cell.summary.failed;
    missing += cell.missing;
  }
  if (failed > 0) notes.push_back(std::to_string(failed) + " trials failed to run and are in no figure");
  if (missing > 0) notes.push_back(std::to_string(missing) + " trials have no record yet");
  return notes;
}

std::string csv(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string number(double value) {
  if (!std::isfinite(value)) return "";
  char buffer[40];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::string csv(const Rate& rate) {
  return std::to_string(rate.hits) + "," + std::to_string(rate.total) + "," + number(rate.rate) + "," +
         number(rate.interval.low) + "," + number(rate.interval.high);
}

std::string csv(const std::optional<SweepDifference>& d) {
  if (!d) return ",,,,,";
  return number(d->value) + "," + number(d->interval.low) + "," + number(d->interval.high) + "," + number(d->p) + "," +
         number(d->p_holm) + "," + std::to_string(d->seeds);
}

constexpr const char* kShareColumns =
    "placed,dropped,cleared,cleared_low,cleared_high,succeeded,attempted,picks,picks_low,picks_high";
constexpr const char* kDifferenceColumns = "difference,difference_low,difference_high,p,p_holm,common_seeds,finding";

}  // namespace

std::string sweep_plan_text(const SweepPlan& plan) {
  std::vector<Row> rows = {{"cell"}};
  for (const SweepFactorPlan& factor : plan.factors) rows[0].push_back(factor.name);
  for (const SweepCellPlan& cell : plan.cells) {
    Row& row = rows.emplace_back(Row{cell.folder});
    row.insert(row.end(), cell.values.begin(), cell.values.end());
  }
  const std::uint64_t seeds = plan.end_seed - plan.first_seed;
  return text::plain_table(rows) + std::to_string(plan.cells.size()) + " cells x " + std::to_string(seeds) +
         " seeds = " + std::to_string(plan.cells.size() * seeds) + " trials\n";
}

std::string sweep_text(const SweepResult& result) {
  std::vector<Row> factors = factor_rows(result), cells = cell_rows(result);
  factors.insert(factors.begin(), factor_head());
  cells.insert(cells.begin(), cell_head(result.plan));
  std::string out = sentence(result) + "\n\n" + text::plain_table(factors) + "\n" + text::plain_table(cells) + "\n";
  for (const std::string& note : notes(result)) out += "  " + note + "\n";
  return out;
}

std::string sweep_markdown(const SweepResult& result) {
  std::string out = "## " + text::markdown(result.plan.name) + "\n\n**" + text::markdown(sentence(result)) + "**\n\n" +
                    text::markdown_table(factor_head(), factor_rows(result)) + "\n" +
                    text::markdown_table(cell_head(result.plan), cell_rows(result)) + "\n";
  for (const std::string& note : notes(result)) out += "- " + text::markdown(note) + "\n";
  return out;
}

std::string sweep_cells_csv(const SweepResult& result) {
  std::string out;
  for (const SweepFactorPlan& factor : result.plan.factors) out += csv(factor.name) + ",";
  out += std::string("trials,failed,missing,") + kShareColumns +
         ",recall_first_look,precision,translation_p95_m,rotation_p95_rad,cycle_median_s," + kDifferenceColumns +
         ",folder\n";
  for (std::size_t c = 0; c < result.cells.size(); ++c) {
    const SweepCell& cell = result.cells[c];
    const CampaignSummary& s = cell.summary;
    for (const std::string& value : result.plan.cells[c].values) out += csv(value) + ",";
    out += std::to_string(s.trials) + "," + std::to_string(s.failed) + "," + std::to_string(cell.missing) + "," +
           csv(s.cleared) + "," + csv(s.picks) + "," + number(s.recall_first_look.rate) + "," +
           number(s.precision.rate) + "," + number(s.translation_p95) + "," + number(s.rotation_p95) + "," +
           number(s.cycle_median) + "," + csv(cell.difference) + "," + finding(result.best == c, cell.difference) +
           "," + csv(result.plan.cells[c].folder) + "\n";
  }
  return out;
}

std::string sweep_factors_csv(const SweepResult& result) {
  std::string out = std::string("factor,level,cells,") + kShareColumns + "," + kDifferenceColumns + "\n";
  for (std::size_t f = 0; f < result.factors.size(); ++f)
    for (std::size_t l = 0; l < result.factors[f].levels.size(); ++l) {
      const SweepLevel& level = result.factors[f].levels[l];
      out += csv(result.plan.factors[f].name) + "," + csv(result.plan.factors[f].levels[l]) + "," +
             std::to_string(level.cells) + "," + csv(level.cleared) + "," + csv(level.picks) + "," +
             csv(level.difference) + "," + finding(result.factors[f].best == l, level.difference) + "\n";
    }
  return out;
}

}  // namespace binpick

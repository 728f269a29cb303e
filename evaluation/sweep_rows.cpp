// The rows of a sweep's tables, as every face of them shows them.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "evaluation/sweep_rows.hpp"

namespace binpick::sweep {
namespace {

using text::fixed;

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

}  // namespace

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

}  // namespace binpick::sweep

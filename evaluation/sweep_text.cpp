// A sweep for people: one sentence, the factors' levels, the cells from the best down. Text, Markdown and CSV.
#include <charconv>
#include <cmath>

#include "evaluation/report_table.hpp"
#include "evaluation/sweep_rows.hpp"

namespace binpick {

std::string cell_label(const SweepCellPlan& cell) {
  std::string label;
  for (const std::string& value : cell.values) label += (label.empty() ? "" : ", ") + value;
  return label;
}

namespace {

using text::Row;

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
  std::vector<Row> factors = sweep::factor_rows(result), cells = sweep::cell_rows(result);
  factors.insert(factors.begin(), sweep::factor_head());
  cells.insert(cells.begin(), sweep::cell_head(result.plan));
  std::string out =
      sweep::sentence(result) + "\n\n" + text::plain_table(factors) + "\n" + text::plain_table(cells) + "\n";
  for (const std::string& note : sweep::notes(result)) out += "  " + note + "\n";
  return out;
}

std::string sweep_markdown(const SweepResult& result) {
  std::string out = "## " + text::markdown(result.plan.name) + "\n\n**" + text::markdown(sweep::sentence(result)) +
                    "**\n\n" + text::markdown_table(sweep::factor_head(), sweep::factor_rows(result)) + "\n" +
                    text::markdown_table(sweep::cell_head(result.plan), sweep::cell_rows(result)) + "\n";
  for (const std::string& note : sweep::notes(result)) out += "- " + text::markdown(note) + "\n";
  return out;
}

std::string sweep_cells_csv(const SweepResult& result) {
  std::string out;
  for (const SweepFactorPlan& factor : result.plan.factors) out += csv_cell(factor.name) + ",";
  out += std::string("trials,failed,missing,") + kShareColumns +
         ",recall_first_look,precision,translation_p95_m,rotation_p95_rad,cycle_median_s," + kDifferenceColumns +
         ",folder\n";
  for (std::size_t c = 0; c < result.cells.size(); ++c) {
    const SweepCell& cell = result.cells[c];
    const CampaignSummary& s = cell.summary;
    for (const std::string& value : result.plan.cells[c].values) out += csv_cell(value) + ",";
    out += std::to_string(s.trials) + "," + std::to_string(s.failed) + "," + std::to_string(cell.missing) + "," +
           csv(s.cleared) + "," + csv(s.picks) + "," + number(s.recall_first_look.rate) + "," +
           number(s.precision.rate) + "," + number(s.translation_p95) + "," + number(s.rotation_p95) + "," +
           number(s.cycle_median) + "," + csv(cell.difference) + "," +
           sweep::finding(result.best == c, cell.difference) + "," + csv_cell(result.plan.cells[c].folder) + "\n";
  }
  return out;
}

std::string sweep_factors_csv(const SweepResult& result) {
  std::string out = std::string("factor,level,cells,") + kShareColumns + "," + kDifferenceColumns + "\n";
  for (std::size_t f = 0; f < result.factors.size(); ++f)
    for (std::size_t l = 0; l < result.factors[f].levels.size(); ++l) {
      const SweepLevel& level = result.factors[f].levels[l];
      out += csv_cell(result.plan.factors[f].name) + "," + csv_cell(result.plan.factors[f].levels[l]) + "," +
             std::to_string(level.cells) + "," + csv(level.cleared) + "," + csv(level.picks) + "," +
             csv(level.difference) + "," + sweep::finding(result.factors[f].best == l, level.difference) + "\n";
    }
  return out;
}

}  // namespace binpick

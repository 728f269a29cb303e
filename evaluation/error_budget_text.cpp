// The error budget for people and programs: text, Markdown, CSV, JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "evaluation/error_budget.hpp"
#include "evaluation/rate_json.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

using json = nlohmann::ordered_json;
using text::fixed;
using text::Row;

std::string share(const Rate& rate) {
  return text::ratio(rate) + " = " + text::percent(rate.rate) + " (" + text::percent(rate.interval) + ")";
}

std::string points(double value) {
  const std::string text = fixed(100 * std::abs(value), 1);
  return text == "0.0" ? text : (value > 0 ? "+" : "-") + text;
}

std::string points(const BudgetGain& gain) {
  return points(gain.value) + " (" + points(gain.interval.low) + " to " + points(gain.interval.high) + ")";
}

std::string p_value(double p) { return p < 1e-3 ? "< 0.001" : fixed(p, 3); }

Row stage_head() {
  return {"told the truth", "parts cleared", "picks succeeded", "cleared, points", "p", "picks, points", "p"};
}

std::vector<Row> stage_rows(const std::vector<BudgetRow>& rows) {
  std::vector<Row> out;
  for (const BudgetRow& row : rows) {
    const bool first = out.empty();
    out.push_back({row.name, share(row.cleared), share(row.picks), first ? "" : points(row.cleared_gain),
                   first ? "" : p_value(row.cleared_gain.p), first ? "" : points(row.picks_gain),
                   first ? "" : p_value(row.picks_gain.p)});
  }
  return out;
}

struct Curve {
  const char *of, *unit;
  double factor;
  const std::vector<BudgetRow>& rows;
};

std::vector<Curve> curves(const ErrorBudget& budget) {
  return {{"position", "mm", text::kToMm, budget.translation}, {"rotation", "deg", text::kToDeg, budget.rotation}};
}

Row curve_head() { return {"error of", "per axis", "picks succeeded", "points", "parts cleared"}; }

std::vector<Row> curve_rows(const ErrorBudget& budget) {
  std::vector<Row> out;
  for (const Curve& curve : curves(budget))
    for (const BudgetRow& row : curve.rows)
      out.push_back({curve.of, fixed(curve.factor * row.error, 1) + " " + curve.unit, share(row.picks),
                     row.error > 0 ? points(row.picks_gain) : "", text::percent(row.cleared.rate)});
  return out;
}

std::vector<std::string> sentences(const ErrorBudget& budget) {
  std::vector<std::string> out;
  for (const std::string& stage : budget.absent) out.push_back(stage + ": perfect in this scene already.");
  for (const Curve& curve : curves(budget)) {
    if (curve.rows.size() < 2) continue;
    const std::optional<double> error = bearable_error(curve.rows);
    const std::string loss = " (five points fewer picks succeed).";
    out.push_back(error ? std::string("This part with this tool bears ") + fixed(curve.factor * *error, 1) + " " +
                              curve.unit + " of error per axis in " + curve.of + loss
                        : std::string("No error in ") + curve.of + " up to " +
                              fixed(curve.factor * curve.rows.back().error, 1) + " " + curve.unit +
                              " per axis is too large" + loss);
  }
  return out;
}

std::string title(const ErrorBudget& budget) {
  return budget.scene + ", seeds " + std::to_string(budget.first_seed) + ":" + std::to_string(budget.end_seed);
}

std::string csv_of(const std::string& table, const BudgetRow& row) {
  const auto number = [](double x) { return std::isfinite(x) ? json(x).dump() : std::string(); };
  std::string line = table + ",\"" + row.name + "\"," + number(row.error) + "," + std::to_string(row.piles);
  for (const Rate* rate : {&row.cleared, &row.picks})
    line += "," + std::to_string(rate->hits) + "," + std::to_string(rate->total) + "," + number(rate->rate) + "," +
            number(rate->interval.low) + "," + number(rate->interval.high);
  for (const BudgetGain* gain : {&row.cleared_gain, &row.picks_gain})
    line += "," + number(gain->value) + "," + number(gain->interval.low) + "," + number(gain->interval.high) + "," +
            number(gain->p);
  return line + "\n";
}

json to_json(const BudgetGain& gain) {
  return {{"value", gain.value}, {"interval", {gain.interval.low, gain.interval.high}}, {"p", gain.p}};
}

json to_json(const std::vector<BudgetRow>& rows) {
  json out = json::array();
  for (const BudgetRow& row : rows)
    out.push_back({{"name", row.name},
                   {"error", row.error},
                   {"piles", row.piles},
                   {"cleared", rate_json(row.cleared, "total", "hits")},
                   {"picks", rate_json(row.picks, "total", "hits")},
                   {"cleared_gain", to_json(row.cleared_gain)},
                   {"picks_gain", to_json(row.picks_gain)}});
  return out;
}

}  // namespace

std::string budget_text(const ErrorBudget& budget) {
  std::string out = "Error budget of " + title(budget) + ": one stage at a time is told the truth\n";
  std::vector<Row> rows = {stage_head()};
  for (Row& row : stage_rows(budget.stages)) rows.push_back(std::move(row));
  if (!budget.stages.empty()) out += text::plain_table(rows);
  rows = {curve_head()};
  for (Row& row : curve_rows(budget)) rows.push_back(std::move(row));
  if (rows.size() > 1) out += "True poses, disturbed\n" + text::plain_table(rows);
  for (const std::string& sentence : sentences(budget)) out += sentence + "\n";
  return out;
}

std::string budget_markdown(const ErrorBudget& budget) {
  std::string out = "# Error budget of " + text::markdown(title(budget)) + "\n\n";
  if (!budget.stages.empty()) out += text::markdown_table(stage_head(), stage_rows(budget.stages)) + "\n";
  if (!budget.translation.empty() || !budget.rotation.empty())
    out += text::markdown_table(curve_head(), curve_rows(budget)) + "\n";
  for (const std::string& sentence : sentences(budget)) out += "- " + text::markdown(sentence) + "\n";
  return out;
}

std::string budget_csv(const ErrorBudget& budget) {
  std::string out =
      "table,name,error,piles,cleared,dropped,cleared_rate,cleared_low,cleared_high,picked,attempted,pick_rate,"
      "pick_low,pick_high,cleared_gain,cleared_gain_low,cleared_gain_high,cleared_p,pick_gain,pick_gain_low,"
      "pick_gain_high,pick_p\n";
  for (const BudgetRow& row : budget.stages) out += csv_of("stages", row);
  for (const BudgetRow& row : budget.translation) out += csv_of("translation", row);
  for (const BudgetRow& row : budget.rotation) out += csv_of("rotation", row);
  return out;
}

std::string budget_json(const ErrorBudget& budget) {
  const auto number = [](const std::optional<double>& x) { return x ? json(*x) : json(nullptr); };
  const json out = {{"schema", 1},
                    {"scene", budget.scene},
                    {"seeds", {budget.first_seed, budget.end_seed}},
                    {"stages", to_json(budget.stages)},
                    {"perfect_already", budget.absent},
                    {"translation", to_json(budget.translation)},
                    {"rotation", to_json(budget.rotation)},
                    {"bearable_translation", number(bearable_error(budget.translation))},
                    {"bearable_rotation", number(bearable_error(budget.rotation))}};
  return out.dump(2) + "\n";
}

}  // namespace binpick

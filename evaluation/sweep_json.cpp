// A sweep for machines: `sweep.json`, which also keeps the plan (docs/sweeps.md).
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "evaluation/rate_json.hpp"
#include "evaluation/sweep_figures.hpp"

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;

Json difference_json(const std::optional<SweepDifference>& d) {
  if (!d) return nullptr;
  return {{"value", d->value}, {"interval", {d->interval.low, d->interval.high}},
          {"p", d->p},         {"p_holm", d->p_holm},
          {"seeds", d->seeds}, {"worse", d->worse}};
}

Json factor_json(const SweepFactorPlan& plan, const SweepFactor& factor) {
  Json levels = Json::array();
  for (std::size_t l = 0; l < plan.levels.size(); ++l) {
    const SweepLevel& level = factor.levels[l];
    levels.push_back({{"label", plan.levels[l]},
                      {"cells", level.cells},
                      {"cleared", rate_json(level.cleared, "dropped", "placed")},
                      {"picks", rate_json(level.picks, "attempted", "succeeded")},
                      {"best", factor.best == l},
                      {"difference", difference_json(level.difference)}});
  }
  return {{"name", plan.name}, {"fields", plan.fields}, {"range", plan.range}, {"levels", levels}};
}

Json cell_json(const SweepCellPlan& plan, const SweepCell& cell, const char* finding) {
  const CampaignSummary& s = cell.summary;
  return {{"folder", plan.folder},
          {"levels", plan.levels},
          {"values", plan.values},
          {"trials", s.trials},
          {"failed", s.failed},
          {"missing", cell.missing},
          {"cleared", rate_json(s.cleared, "dropped", "placed")},
          {"picks", rate_json(s.picks, "attempted", "succeeded")},
          {"recall_first_look", rate_json(s.recall_first_look, "visible", "found")},
          {"precision", rate_json(s.precision, "counted", "right")},
          {"translation_error_m", {{"median", s.translation_median}, {"p95", s.translation_p95}}},
          {"rotation_error_rad", {{"median", s.rotation_median}, {"p95", s.rotation_p95}}},
          {"cycle_s", {{"median", s.cycle_median}}},
          {"outcomes", s.outcomes},
          {"finding", finding},
          {"difference", difference_json(cell.difference)}};
}

const char* finding(const SweepResult& result, std::size_t c) {
  if (result.best == c) return "best";
  const std::optional<SweepDifference>& d = result.cells[c].difference;
  return !d ? "unknown" : d->worse ? "worse" : "not_worse";
}

Json map_json(const HeatMap& map, const std::string& picture) {
  Json json = {{"rows", map.rows},   {"columns", map.columns}, {"given", nullptr},
               {"rates", map.share}, {"trials", map.trials},   {"picture", picture}};
  if (map.given) json["given"] = {{"factor", map.given->first}, {"level", map.given->second}};
  return json;
}

/// The value, or an error that names file and key.
template <class T>
T taken(const Json& json, const char* key, const std::string& file) {
  try {
    return json.at(key).get<T>();
  } catch (const nlohmann::json::exception&) {
    throw SpecError(file + ": " + key + ": is missing or no such value as a sweep has there");
  }
}

/// A run folder inside the sweep's own: nothing else is read or written by its name.
bool is_inside(const std::string& folder) {
  return folder.rfind("cells/", 0) == 0 && folder.find('/', 6) == std::string::npos && folder.size() > 6 &&
         folder.find("..") == std::string::npos;
}

void check(const SweepPlan& plan, const std::string& file) {
  const auto fail = [&](const std::string& what) { throw SpecError(file + ": " + what); };
  if (plan.first_seed >= plan.end_seed) fail("seeds: there is none");
  for (const SweepFactorPlan& factor : plan.factors)
    if (factor.levels.empty()) fail("factors: " + factor.name + " has no level");
  for (const SweepCellPlan& cell : plan.cells) {
    if (!is_inside(cell.folder)) fail("cells: folder '" + cell.folder + "' is not in cells/");
    bool fits = cell.levels.size() == plan.factors.size() && cell.values.size() == plan.factors.size();
    for (std::size_t f = 0; fits && f < plan.factors.size(); ++f) fits = cell.levels[f] < plan.factors[f].levels.size();
    if (!fits) fail("cells: " + cell.folder + " does not fit the factors");
  }
}

}  // namespace

std::string sweep_json(const SweepResult& result, std::span<const std::string> pictures) {
  const SweepPlan& plan = result.plan;
  Json json = {{"schema", kSweepSchema},
               {"name", plan.name},
               {"base", plan.base},
               {"design", plan.design},
               {"objective", plan.objective},
               {"alpha", plan.alpha},
               {"confidence", 0.95},
               {"seeds", {plan.first_seed, plan.end_seed}},
               {"best", result.best ? Json(*result.best) : Json(nullptr)},
               {"not_worse", not_worse(result)}};
  json["factors"] = Json::array();
  for (std::size_t f = 0; f < plan.factors.size(); ++f)
    json["factors"].push_back(factor_json(plan.factors[f], result.factors[f]));
  json["cells"] = Json::array();
  for (std::size_t c = 0; c < plan.cells.size(); ++c)
    json["cells"].push_back(cell_json(plan.cells[c], result.cells[c], finding(result, c)));
  json["heat_maps"] = Json::array();
  for (std::size_t m = 0; m < result.heat_maps.size(); ++m)
    json["heat_maps"].push_back(map_json(result.heat_maps[m], m < pictures.size() ? pictures[m] : ""));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

SweepPlan read_sweep_plan(const std::string& folder) {
  const std::string file = folder + "/sweep.json";
  const Json json = Json::parse(read_file(file), nullptr, false);
  if (json.is_discarded() || !json.is_object()) throw SpecError(file + ": is not JSON of a sweep");
  if (const int schema = taken<int>(json, "schema", file); schema != kSweepSchema)
    throw SpecError(file + ": schema: " + std::to_string(schema) + " is not " + std::to_string(kSweepSchema) +
                    ", which is read here");
  SweepPlan plan;
  plan.name = taken<std::string>(json, "name", file);
  plan.base = taken<std::string>(json, "base", file);
  plan.design = taken<std::string>(json, "design", file);
  plan.objective = taken<std::string>(json, "objective", file);
  plan.alpha = taken<double>(json, "alpha", file);
  const auto seeds = taken<std::vector<std::uint64_t>>(json, "seeds", file);
  if (seeds.size() != 2) throw SpecError(file + ": seeds: must be [first, end]");
  plan.first_seed = seeds[0];
  plan.end_seed = seeds[1];
  for (const Json& factor : taken<std::vector<Json>>(json, "factors", file)) {
    plan.factors.push_back({taken<std::string>(factor, "name", file),
                            taken<std::vector<std::string>>(factor, "fields", file),
                            {},
                            taken<bool>(factor, "range", file)});
    for (const Json& level : taken<std::vector<Json>>(factor, "levels", file))
      plan.factors.back().levels.push_back(taken<std::string>(level, "label", file));
  }
  for (const Json& cell : taken<std::vector<Json>>(json, "cells", file))
    plan.cells.push_back({taken<std::string>(cell, "folder", file),
                          taken<std::vector<std::size_t>>(cell, "levels", file),
                          taken<std::vector<std::string>>(cell, "values", file)});
  check(plan, file);
  return plan;
}

}  // namespace binpick

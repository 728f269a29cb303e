#include "trials/sweep.hpp"

#include <algorithm>
#include <charconv>
#include <set>

#include "core/error.hpp"
#include "core/yaml.hpp"

namespace binpick {
namespace {

constexpr std::size_t kMostCells = 10000;
constexpr std::uint64_t kMostTrials = 1000000;

using Factor = SweepSetup::Factor;

void add_field(Factor& factor, const std::string& field) {
  if (std::find(factor.fields.begin(), factor.fields.end(), field) == factor.fields.end())
    factor.fields.push_back(field);
}

void add_level(Factor& factor, const YamlValue& at, SweepSetup::Level level) {
  for (const SweepSetup::Level& other : factor.levels)
    if (other.label == level.label) at.fail(factor.name + ": the level '" + level.label + "' is there twice");
  if (level.label.empty()) at.fail(factor.name + ": a level's name is empty");
  for (const YamlSetting& setting : level.settings) add_field(factor, setting.field);
  factor.levels.push_back(std::move(level));
}

/// [500 mm, 600 mm] for one field, or {label: value} for it, or without a field {label: {field: value, ..}}.
void read_levels(Factor& factor, const std::string& field, const YamlValue& levels) {
  if (levels.is_list()) {
    if (field.empty())
      levels.fail(factor.name + ": a list of levels needs a `field`; or name them: {label: {field: value}}");
    for (const YamlValue& value : levels.items()) add_level(factor, value, {value.text(), {{field, value}}});
  } else if (levels.is_mapping()) {
    for (const auto& [label, value] : levels.entries()) {
      SweepSetup::Level level{label.scalar(), {}};
      if (!field.empty()) {
        level.settings.push_back({field, value});
      } else {
        if (!value.is_mapping())
          value.fail(factor.name + ": " + level.label + ": without a `field` a level is {field: value, ..}");
        for (const auto& [name, set] : value.entries()) level.settings.push_back({name.scalar(), set});
      }
      add_level(factor, label, std::move(level));
    }
  } else {
    levels.fail(factor.name + ": levels must be a list or {label: value}");
  }
  if (factor.levels.empty()) levels.fail(factor.name + ": has no level");
}

double number_of(const YamlValue& value, const std::string& what, std::string& unit) {
  const std::string text = value.scalar();
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !(number - number == 0))
    value.fail(what + ": '" + text + "' is not a number, with or without a unit");
  unit.assign(end, text.data() + text.size());
  return number;
}

void read_range(Factor& factor, const std::string& field, const YamlValue& range, const YamlValue* step) {
  const std::vector<YamlValue> ends = range.items();
  if (ends.size() != 2) range.fail(factor.name + ": range must be [low, high]");
  SweepSetup::Range read{field, "", 0, 1, 0, range};
  std::string unit;
  read.low = number_of(ends[0], factor.name + ": range", unit);
  read.high = number_of(ends[1], factor.name + ": range", read.unit);
  if (unit != read.unit) range.fail(factor.name + ": both ends of a range need the same unit");
  if (!(read.low < read.high)) range.fail(factor.name + ": the range's low end must lie below its high end");
  if (step) {
    read.step = number_of(*step, factor.name + ": step", unit);
    if (unit != read.unit || !(read.step > 0))
      step->fail(factor.name + ": step must be a positive number of the range's unit");
  }
  add_field(factor, field);
  factor.range = std::move(read);
}

/// `path: [..]`, or `name: {field, levels}`, or `name: {field, range, step}`.
Factor read_factor(const YamlValue& name, const YamlValue& value) {
  Factor factor{name.scalar(), name, {}, {}, std::nullopt};
  if (factor.name.empty()) name.fail("a factor's name is empty");
  if (value.is_list()) {
    read_levels(factor, factor.name, value);
    return factor;
  }
  const YamlValue *levels = nullptr, *range = nullptr, *step = nullptr;
  std::string field;
  const auto entries = value.entries();
  for (const auto& [key, entry] : entries) {
    const std::string word = key.scalar();
    if (word == "field")
      field = entry.scalar();
    else if (word == "levels")
      levels = &entry;
    else if (word == "range")
      range = &entry;
    else if (word == "step")
      step = &entry;
    else {
      const std::string near = nearest_name(word, {"field", "levels", "range", "step"});
      key.fail(factor.name + "." + word + ": unknown key" + (near.empty() ? "" : ", did you mean " + near + "?"));
    }
  }
  if ((levels != nullptr) == (range != nullptr)) value.fail(factor.name + ": needs either levels or a range");
  if (step && !range) step->fail(factor.name + ": step belongs to a range");
  if (range)
    read_range(factor, field.empty() ? factor.name : field, *range, step);
  else
    read_levels(factor, field, *levels);
  return factor;
}

/// Does one path lie in what the other sets?
bool overlap(const std::string& a, const std::string& b) {
  const std::string& shorter = a.size() < b.size() ? a : b;
  const std::string& longer = a.size() < b.size() ? b : a;
  if (longer.rfind(shorter, 0) != 0) return false;
  return longer.size() == shorter.size() || longer[shorter.size()] == '.' || longer[shorter.size()] == '[';
}

/// A field that two factors set, or one of them twice, would be what came last.
void check_fields(const std::vector<Factor>& factors) {
  for (std::size_t f = 0; f < factors.size(); ++f) {
    for (std::size_t g = 0; g < f; ++g)
      for (const std::string& a : factors[f].fields)
        for (const std::string& b : factors[g].fields)
          if (overlap(a, b))
            factors[f].at.fail(factors[f].name + ": " + a + " is set by " + factors[g].name + " (" +
                               factors[g].at.place() + (a == b ? ") too" : ", as " + b + ") too"));
    for (const SweepSetup::Level& level : factors[f].levels)
      for (std::size_t k = 0; k < level.settings.size(); ++k)
        for (std::size_t l = 0; l < k; ++l)
          if (overlap(level.settings[k].field, level.settings[l].field))
            level.settings[k].value.fail(factors[f].name + ": " + level.label + ": " + level.settings[k].field +
                                         " and " + level.settings[l].field + " set the same");
  }
}

void read_seeds(const ConfigVisitor& v, const std::string& text, SweepPlan& plan) {
  const std::size_t colon = text.find(':');
  const auto read = [](const std::string& part, std::uint64_t& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size();
  };
  if (colon == std::string::npos || !read(text.substr(0, colon), plan.first_seed) ||
      !read(text.substr(colon + 1), plan.end_seed) || plan.first_seed >= plan.end_seed)
    v.fail("seeds", "'" + text + "' must be A:B with A < B, meaning the seeds A to B-1");
}

void visit(ConfigVisitor& v, SweepSetup& sweep) {
  std::string seeds;
  int seed = 1;
  v.field("name", sweep.plan.name, "shown in tables");
  for (const char* key : {"base", "seeds", "factors"})
    if (!v.has(key)) v.fail(key, "is missing");
  v.path("base", sweep.base, "scenario that the factors change");
  v.field("seeds", seeds, "A:B, the seeds A to B-1 of every cell");
  read_seeds(v, seeds, sweep.plan);
  v.choice("design", sweep.plan.design, {"grid", "latin_hypercube"}, "every combination, or points in ranges");
  v.field("points", sweep.points, "cells of a Latin hypercube");
  v.field("seed", seed, "that it is drawn from");
  if (seed < 0) v.fail("seed", "must not be negative");
  sweep.seed = static_cast<std::uint64_t>(seed);
  v.choice("objective", sweep.plan.objective, {"cleared", "picks"}, "what the best cell is best in");
  v.field("alpha", sweep.plan.alpha, Unit::kNone, "chance that anything is called worse and is not");
  if (!(sweep.plan.alpha > 0 && sweep.plan.alpha < 1)) v.fail("alpha", "must lie between 0 and 1");
  const bool hypercube = sweep.plan.design == "latin_hypercube";
  if (hypercube && (sweep.points < 2 || sweep.points > static_cast<int>(kMostCells)))
    v.fail("points", "a Latin hypercube needs 2 to " + std::to_string(kMostCells) + " points");
  for (const char* key : {"points", "seed"})
    if (!hypercube && v.has(key)) v.fail(key, "belongs to `design: latin_hypercube`");
}

void check_size(const SweepSetup& sweep, const YamlValue& factors) {
  std::uint64_t cells = 1;
  if (sweep.plan.design == "latin_hypercube")
    cells = static_cast<std::uint64_t>(sweep.points);
  else
    for (const Factor& factor : sweep.factors) {
      if (factor.range)
        factor.range->at.fail(factor.name + ": a range needs `design: latin_hypercube`; a grid needs levels");
      cells = std::min<std::uint64_t>(cells * factor.levels.size(), kMostCells + 1);
    }
  if (cells > kMostCells) factors.fail("factors: more than " + std::to_string(kMostCells) + " cells");
  if ((sweep.plan.end_seed - sweep.plan.first_seed) > kMostTrials / cells)
    factors.fail("factors: more than a million trials in one sweep");
}

}  // namespace

SweepSetup read_sweep(const std::string& path) {
  SweepSetup sweep;
  sweep.file = path;
  sweep.plan.name = "sweep";
  const YamlValue root = YamlValue::from_file(path);
  root.visit([&](ConfigVisitor& v) { visit(v, sweep); }, {"factors"});
  for (const auto& [key, value] : root.entries()) {
    if (key.scalar() == "base") sweep.plan.base = value.scalar();
    if (key.scalar() != "factors") continue;
    for (const auto& [name, factor] : value.entries()) sweep.factors.push_back(read_factor(name, factor));
    if (sweep.factors.empty()) value.fail("factors: there is none");
    check_fields(sweep.factors);
    check_size(sweep, value);
  }
  sweep.plan.design == "grid" ? expand_grid(sweep) : expand_latin_hypercube(sweep);
  read_scenario(sweep.base);  // what is wrong without any factor is the base's own fault
  return sweep;
}

namespace {

/// What is said of a scene with these settings; empty: nothing is wrong.
std::string complaint(const std::string& base, const std::vector<YamlSetting>& settings) {
  try {
    ScenarioOverrides overrides;
    overrides.settings = settings;
    read_scenario(base, overrides);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

Scenario cell_scenario(const SweepSetup& sweep, std::size_t cell) {
  ScenarioOverrides overrides;
  overrides.settings = sweep.settings[cell];
  const std::string label = cell_label(sweep.plan.cells[cell]);
  std::string what;
  try {
    Scenario scenario = read_scenario(sweep.base, overrides);
    scenario.name = sweep.plan.name + ": " + label;
    return scenario;
  } catch (const SpecError& error) {
    what = error.what();
  } catch (const AssetError& error) {
    what = error.what();
  }
  if (what.rfind(sweep.file + ":", 0) == 0) throw SpecError(what);
  // One field alone may be the reason; else it is the company they keep.
  for (const YamlSetting& setting : overrides.settings)
    if (const std::string alone = complaint(sweep.base, {setting}); !alone.empty())
      setting.value.fail(setting.field + " = " + setting.value.text() + ": " + alone);
  throw SpecError(sweep.factors.front().at.place() + ": factors: the cell (" + label + "): " + what);
}

}  // namespace binpick

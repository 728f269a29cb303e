// Cells of a sweep from its factors: every combination, or a Latin hypercube.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/error.hpp"
#include "core/random.hpp"
#include "trials/sweep.hpp"

namespace binpick {
namespace {

/// A folder's name from what stands for the levels: letters, digits and a few marks.
std::string folder_name(const std::vector<std::string>& values) {
  std::string name;
  for (const std::string& value : values) {
    std::string word;
    for (const char c : value) {
      const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '+';
      if (plain || (!word.empty() && word.back() != '_')) word += plain ? c : '_';
    }
    while (!word.empty() && (word.back() == '_' || word.back() == '.')) word.pop_back();
    word.erase(0, word.find_first_not_of('.'));
    name += (name.empty() ? "" : "-") + (word.empty() ? "x" : word);
  }
  return name.substr(0, 120);
}

class Cells {
 public:
  explicit Cells(SweepSetup& sweep) : sweep_(sweep) {}

  void add(SweepCellPlan cell, std::vector<YamlSetting> settings, const std::string& name) {
    std::string folder = name;
    for (int k = 2; !names_.insert(folder).second; ++k) folder = name + "-" + std::to_string(k);
    cell.folder = "cells/" + folder;
    sweep_.plan.cells.push_back(std::move(cell));
    sweep_.settings.push_back(std::move(settings));
  }

 private:
  SweepSetup& sweep_;
  std::set<std::string> names_;
};

std::string in_digits(double value, const std::string& unit) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text + unit;
}

double at_share(const SweepSetup::Range& range, double share) {
  const double value = range.low + share * (range.high - range.low);
  if (range.step <= 0) return value;
  return std::min(range.high, range.low + std::round((value - range.low) / range.step) * range.step);
}

/// A range is shown in thirds, or in halves where its points fall into halves only.
std::size_t parts_of(int points) { return points % 3 != 0 && points % 2 == 0 ? 2 : 3; }

std::vector<std::string> part_labels(const SweepSetup::Range& range, std::size_t parts) {
  std::vector<std::string> labels;
  for (std::size_t k = 0; k < parts; ++k) {
    const auto end = [&](std::size_t i) {
      return range.low + (range.high - range.low) * static_cast<double>(i) / static_cast<double>(parts);
    };
    labels.push_back(in_digits(end(k), "") + " .. " + in_digits(end(k + 1), range.unit));
  }
  return labels;
}

}  // namespace

void expand_grid(SweepSetup& sweep) {
  for (const SweepSetup::Factor& factor : sweep.factors) {
    SweepFactorPlan plan{factor.name, factor.fields, {}, false};
    for (const SweepSetup::Level& level : factor.levels) plan.levels.push_back(level.label);
    sweep.plan.factors.push_back(plan);
  }
  Cells cells(sweep);
  std::vector<std::size_t> at(sweep.factors.size(), 0);
  for (bool more = true; more;) {
    SweepCellPlan cell{"", at, {}};
    std::vector<YamlSetting> settings;
    for (std::size_t f = 0; f < at.size(); ++f) {
      const SweepSetup::Level& level = sweep.factors[f].levels[at[f]];
      cell.values.push_back(level.label);
      settings.insert(settings.end(), level.settings.begin(), level.settings.end());
    }
    const std::string name = folder_name(cell.values);
    cells.add(std::move(cell), std::move(settings), name);
    more = false;
    for (std::size_t f = at.size(); f-- > 0 && !more;) {  // the last factor turns fastest
      more = ++at[f] < sweep.factors[f].levels.size();
      if (!more) at[f] = 0;
    }
  }
}

// McKay, Beckman and Conover 1979: each factor's range is cut into as many strata as there are points, every stratum is
// used once, and which strata meet is drawn. A factor draws from a stream of its own name, so that another factor
// changes nothing for it.
void expand_latin_hypercube(SweepSetup& sweep) {
  const auto points = static_cast<std::size_t>(sweep.points);
  const double count = static_cast<double>(points);
  std::vector<SweepCellPlan> cells(points);
  std::vector<std::vector<YamlSetting>> settings(points);
  for (const SweepSetup::Factor& factor : sweep.factors) {
    std::vector<std::size_t> strata(points);
    for (std::size_t k = 0; k < points; ++k) strata[k] = k;
    Rng rng = Seed{sweep.seed}.child("latin_hypercube").child(factor.name).rng();
    rng.shuffle(strata);
    SweepFactorPlan plan{factor.name, factor.fields, {}, factor.range.has_value()};
    const std::size_t parts = factor.range ? parts_of(sweep.points) : factor.levels.size();
    if (factor.range) plan.levels = part_labels(*factor.range, parts);
    for (const SweepSetup::Level& level : factor.levels) plan.levels.push_back(level.label);
    for (std::size_t k = 0; k < points; ++k) {
      const std::size_t level = strata[k] * parts / points;
      const double share = (static_cast<double>(strata[k]) + rng.uniform()) / count;
      cells[k].levels.push_back(level);
      if (factor.range) {
        const std::string value = in_digits(at_share(*factor.range, share), factor.range->unit);
        cells[k].values.push_back(value);
        settings[k].push_back({factor.range->field, factor.range->at.with_text(value)});
      } else {
        cells[k].values.push_back(factor.levels[level].label);
        for (const YamlSetting& setting : factor.levels[level].settings) settings[k].push_back(setting);
      }
    }
    sweep.plan.factors.push_back(plan);
  }
  Cells folders(sweep);
  const int digits = static_cast<int>(std::to_string(points).size());
  for (std::size_t k = 0; k < points; ++k) {
    char name[40];
    std::snprintf(name, sizeof name, "point-%0*zu", digits, k + 1);
    folders.add(std::move(cells[k]), std::move(settings[k]), name);
  }
}

}  // namespace binpick

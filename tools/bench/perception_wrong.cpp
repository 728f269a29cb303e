#include "tools/bench/perception_wrong.hpp"

#include <algorithm>
#include <cstdio>

#include "core/error.hpp"

namespace binpick {
namespace {

struct WrongCount {
  std::size_t poses = 0, views_with = 0, views = 0;
  double largest = 0;  ///< score

  void add(const PerceptionRow& row) {
    for (const LookScore& look : row.looks) {
      ++views;
      views_with += look.wrong.empty() ? 0 : 1;
      poses += look.wrong.size();
      for (const WrongEstimate& wrong : look.wrong) largest = std::max(largest, wrong.score);
    }
  }
  std::string cell() const {
    if (views == 0) return "-";
    if (poses == 0) return "0";
    char text[64];
    std::snprintf(text, sizeof text, "%zu in %zu (%.2f)", poses, views_with, largest);
    return text;
  }
};

std::vector<std::string> names_in_order(std::span<const PerceptionRow> rows, std::string PerceptionRow::*field) {
  std::vector<std::string> names;
  for (const PerceptionRow& row : rows)
    if (std::find(names.begin(), names.end(), row.*field) == names.end()) names.push_back(row.*field);
  return names;
}

std::string table_of_sensor(std::span<const PerceptionRow> rows, const std::string& sensor) {
  const std::vector<std::string> parts = names_in_order(rows, &PerceptionRow::part);
  const std::vector<std::string> scenes = names_in_order(rows, &PerceptionRow::scene);
  std::string text = "| " + sensor + ", looked for |", rule = "| --- |";
  for (const std::string& scene : scenes) text += " in " + scene + " |", rule += " --- |";
  text += "\n" + rule + "\n";
  WrongCount all;
  for (const std::string& part : parts) {
    text += "| " + part + " |";
    for (const std::string& scene : scenes) {
      WrongCount count;
      for (const PerceptionRow& row : rows)
        if (row.sensor == sensor && row.part == part && row.scene == scene) count.add(row), all.add(row);
      text += " " + count.cell() + " |";
    }
    text += "\n";
  }
  char sum[160];
  std::snprintf(sum, sizeof sum, "\n%zu poses in %zu of %zu views.\n\n", all.poses, all.views_with, all.views);
  return text + sum;
}

}  // namespace

std::vector<PerceptionRow> bench_wrong_parts(const PerceptionBenchConfig& config, ProgressSink& progress) {
  std::vector<PerceptionRow> rows;
  for (const std::string& sought : config.scenes) {
    const Scenario scenario = scaled_scenario(sought, {}, config.part_scale * config.sought_scale);
    if (scenario.parts.size() != 1) throw SpecError(sought + ": --wrong wants scenes with one kind of part");
    PerceptionBenchConfig one = config;
    one.trouble.other_part = scenario.parts[0].spec;
    std::erase(one.scenes, sought);
    for (PerceptionRow& row : bench_perception(one, progress)) rows.push_back(std::move(row));
  }
  return rows;
}

std::string wrong_parts_table(std::span<const PerceptionRow> rows) {
  std::string text;
  for (const std::string& sensor : names_in_order(rows, &PerceptionRow::sensor)) text += table_of_sensor(rows, sensor);
  return text;
}

}  // namespace binpick

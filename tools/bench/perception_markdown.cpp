// Figures as Markdown: results by part and sensor, and the ablation.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tools/bench/perception_ablation.hpp"
#include "tools/bench/perception_rows.hpp"

namespace binpick {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

std::string percent(const Rate& rate) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f (%.1f-%.1f)", 100 * rate.rate, 100 * rate.interval.low,
                100 * rate.interval.high);
  return rate.total == 0 ? "-" : text;
}

std::string number(double value, const char* format) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return std::isnan(value) ? "-" : text;
}

std::string line_of(const PerceptionRow& row) {
  const RowFigures f = figures_of(row);
  std::string line = "| " + row.contender + " | " + percent(f.recall) + " | " + percent(f.recall_partly) + " | " +
                     percent(f.precision) + " | " + number(100 * f.top1.rate, "%.0f");
  line += " | " + number(1e3 * f.lateral_median, "%.2f") + " | " + number(1e3 * f.abs_z_median, "%.2f") + " | " +
          number(kDegrees * f.rotation_median, "%.2f");
  return line + " | " + number(f.median.cpu, "%.0f") + " |\n";
}

std::string result_line(const PerceptionRow& row) {
  const RowFigures f = figures_of(row);
  std::string line = "| " + row.part + " | " + row.sensor + " | " + row.contender + " | " +
                     std::to_string(row.looks.size()) + " | " + percent(f.recall) + " | " + percent(f.recall_partly) +
                     " | " + percent(f.precision) + " | " + percent(f.top1);
  line += " | " + percent(f.recall_clear) + " | " + percent(f.precision_clear) + " | " + percent(f.top1_clear);
  line += " | " + number(1e3 * f.translation_median, "%.2f") + " / " + number(1e3 * f.translation_p95, "%.2f") + " | " +
          number(kDegrees * f.rotation_median, "%.2f") + " / " + number(kDegrees * f.rotation_p95, "%.2f") + " | " +
          number(1e3 * f.z_bias, "%.2f");
  line += " | " + number(f.median.total, "%.0f") + " | " + number(f.median.cpu, "%.0f") + " | " +
          number(f.median.first, "%.0f") + " | " + number(row.training.ms, "%.0f") + " | " +
          number(1e-6 * static_cast<double>(row.training.table_bytes), "%.1f");
  return line + " |\n";
}

}  // namespace

std::string markdown_of(std::span<const PerceptionRow> rows) {
  std::string out =
      "| part | sensor | estimator | heaps | recall % | recall % (0.3-0.5) | precision % | top-1 % | recall %, clear "
      "views | precision %, clear views | top-1 %, clear views | translation mm, median / p95 | rotation deg, median / "
      "p95 | z bias mm | ms | CPU ms | first pose ms | training ms | tables MB |\n|";
  for (int column = 0; column < 19; ++column) out += "---|";
  out += "\n";
  for (const PerceptionRow& row : rows) out += result_line(row);
  return out;
}

std::string ablation_table(std::span<const PerceptionRow> rows) {
  std::string out, last;
  for (const PerceptionRow& row : rows) {
    const std::string question = row.part + ", " + row.sensor;
    if (row.contender == rows.front().contender || question != last) {
      const bool fresh = question != last;
      last = question;
      if (fresh)
        out += (out.empty() ? "" : "\n") + ("**" + question + "**, " + std::to_string(row.looks.size())) +
               " heaps\n\n| variant | recall % (visible >= 0.5) | recall % (0.3-0.5) | precision % | top-1 % | lateral "
               "mm | z mm | rotation deg | CPU ms |\n|---|---|---|---|---|---|---|---|---|\n";
    }
    out += line_of(row);
  }
  return out;
}

}  // namespace binpick

#include "tools/bench/perception_ablation.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

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

}  // namespace

std::vector<ContenderSpec> ablation_variants() {
  struct Variant {
    const char *name, *type;
    std::vector<std::string> settings;
  };
  const Variant variants[] = {
      {"ppf, all steps", "ppf", {}},
      {"without edge votes", "ppf", {"search.edges=false"}},
      {"without floor calibration", "ppf", {"preprocess.calibrate_floor=false"}},
      {"without silhouette in the ICP", "ppf", {"icp.silhouette=false"}},
      {"one search round", "ppf", {"search.rounds=1"}},
      {"table cells over 300 skipped", "ppf", {"voting.largest_cell=300"}},
      {"one peak a reference", "ppf", {"voting.peaks=1"}},
      {"paper's pair radius (half the diameter)", "ppf", {"voting.pair_radius=0.5"}},
      {"without a quota for each region", "ppf", {"search.regional=1000000"}},
      {"fixed tolerances, not the sensor's sigma", "ppf", {"check.tolerance_sigmas=0", "icp.accept_sigmas=0"}},
      {"without the leak test", "ppf", {"accept.largest_leak=1"}},
      {"without ownership of pixels", "ppf", {"accept.least_own=0"}},
      {"without the overlap test", "ppf", {"accept.largest_overlap=1"}},
      {"paper_ppf", "paper_ppf", {}},
  };
  std::vector<ContenderSpec> specs;
  for (const Variant& v : variants) specs.push_back({v.name, v.type, v.settings, ""});
  return specs;
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

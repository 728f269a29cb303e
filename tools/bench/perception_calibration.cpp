#include "tools/bench/perception_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "core/check.hpp"
#include "core/file_io.hpp"
#include "tools/validate/plot.hpp"

namespace binpick {
namespace {

constexpr int kBins = 10;

using Pools = std::vector<std::pair<std::string, std::vector<ScoredEstimate>>>;

void add_to(Pools& pools, const std::string& name, const PerceptionRow& row) {
  auto pool = std::find_if(pools.begin(), pools.end(), [&](const auto& p) { return p.first == name; });
  if (pool == pools.end()) pool = pools.insert(pools.end(), {name, {}});
  for (const LookScore& look : row.looks)
    pool->second.insert(pool->second.end(), look.scored.begin(), look.scored.end());
}

std::string commands_for(const Pools& pools) {
  std::string curves;
  for (std::size_t k = 0; k < pools.size(); ++k) {
    const std::string name = pools[k].first, colour = std::to_string(1 + k % 10);
    curves +=
        ", \\\n file using (curve('" + name + "',2)):3:4:5 with yerrorlines lt " + colour + " title '" + name + "'";
  }
  return "set xlabel 'score'\nset ylabel 'share of right estimates'\nset key bottom right\nset xrange [0:1]\n"
         "set yrange [0:1]\nplot x with lines lc rgb '#999999' dashtype 2 title 'as it should be'" +
         curves + "\n";
}

}  // namespace

std::vector<ReliabilityBin> reliability(std::span<const ScoredEstimate> estimates, int bins) {
  BP_CHECK(bins > 0, bins << " bins");
  std::vector<ReliabilityBin> all(static_cast<std::size_t>(bins));
  for (int b = 0; b < bins; ++b) {
    all[static_cast<std::size_t>(b)].low = static_cast<double>(b) / bins;
    all[static_cast<std::size_t>(b)].high = static_cast<double>(b + 1) / bins;
  }
  for (const ScoredEstimate& e : estimates) {
    const double place = std::clamp(e.score, 0.0, 1.0) * bins;
    ReliabilityBin& bin = all[std::min(static_cast<std::size_t>(place), all.size() - 1)];
    bin.mean_score += e.score;
    bin.right += e.right ? 1 : 0;
    ++bin.total;
  }
  std::erase_if(all, [](const ReliabilityBin& bin) { return bin.total == 0; });
  for (ReliabilityBin& bin : all) {
    bin.mean_score /= static_cast<double>(bin.total);
    bin.interval = wilson_interval(bin.right, bin.total);
  }
  return all;
}

double calibration_error(std::span<const ReliabilityBin> bins) {
  double sum = 0, total = 0;
  for (const ReliabilityBin& bin : bins) {
    const double n = static_cast<double>(bin.total);
    sum += n * std::abs(bin.mean_score - static_cast<double>(bin.right) / n);
    total += n;
  }
  return total > 0 ? sum / total : std::numeric_limits<double>::quiet_NaN();
}

std::string write_calibration(std::span<const PerceptionRow> rows, const std::string& folder) {
  Pools pools, parts;
  for (const PerceptionRow& row : rows) {
    add_to(pools, row.contender + " (all parts)", row);
    add_to(parts, row.contender + " " + row.part, row);
  }
  const std::size_t whole = pools.size();
  pools.insert(pools.end(), parts.begin(), parts.end());
  make_folder(folder);
  CurveTable table("estimates of,mean score,share right,interval low,interval high,right,total");
  std::string out;
  for (std::size_t k = 0; k < pools.size(); ++k) {
    const std::vector<ReliabilityBin> bins = reliability(pools[k].second, kBins);
    char line[160];
    std::snprintf(line, sizeof line, "%s: calibration error %.3f\n", pools[k].first.c_str(), calibration_error(bins));
    if (k < whole) out += line;
    for (const ReliabilityBin& bin : bins) {
      const double n = static_cast<double>(bin.total), share = static_cast<double>(bin.right) / n;
      table.add(pools[k].first,
                {bin.mean_score, share, bin.interval.low, bin.interval.high, static_cast<double>(bin.right), n});
      std::snprintf(line, sizeof line, "  score %.1f-%.1f: %zu of %zu right, %.1f %% [%.1f-%.1f]\n", bin.low, bin.high,
                    bin.right, bin.total, 100 * share, 100 * bin.interval.low, 100 * bin.interval.high);
      if (k < whole) out += line;
    }
  }
  write_plot(folder, "calibration", table, commands_for(pools));
  if (!draw_plots(folder, {"calibration"})) out += "gnuplot is not installed: no picture\n";
  return out;
}

}  // namespace binpick

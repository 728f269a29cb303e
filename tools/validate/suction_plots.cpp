// The loads of V-B1 and V-B4 as curves: pull-off over the cup's diameter, peel over the lever arm, beside theory.

#include <cmath>
#include <numbers>

#include "tools/validate/plot.hpp"
#include "tools/validate/suction_bench.hpp"

namespace binpick {
namespace {

std::string plot_pull_off(const std::string& folder) {
  CurveTable table("curve,diameter_mm,measured_n,theory_n");
  for (const double vacuum : {60e3, 80e3})
    for (const double diameter : {0.006, 0.008, 0.010, 0.015, 0.020, 0.025, 0.030, 0.040}) {
      const double theory = vacuum * std::numbers::pi * diameter * diameter / 4;
      const double load = measure_pull_off(diameter, vacuum, 0.05 * theory, 1).load;
      table.add(vacuum < 70e3 ? "60 kPa" : "80 kPa", {1e3 * diameter, load, theory});
    }
  write_plot(folder, "pull_off", table, R"gp(
set title "Load that pulls a flat cup off a plate (V-B1): measured (points), vacuum times area (lines)"
set logscale xy
set xlabel "cup diameter, mm"
set ylabel "m (g + a), N"
set xrange [5:45]
set xtics (6, 8, 10, 15, 20, 25, 30, 40)
set key top left
plot for [name in '"60 kPa" "80 kPa"'] file using (curve(name, 2)):4 with lines notitle, \
  for [name in '"60 kPa" "80 kPa"'] file using (curve(name, 2)):3 with points title name
)gp");
  return "pull_off";
}

std::string plot_peel(const std::string& folder) {
  CurveTable table("curve,lever_mm,measured_n,theory_n");
  for (const double off : {0.0, 0.005, 0.010, 0.015, 0.020, 0.030, 0.040}) {
    const double theory = 60e3 * std::numbers::pi * 1e-4 / (1 + off / 0.010);
    table.add("peel", {1e3 * off, measure_peel(off, 0.02 * theory, 1), theory});
  }
  write_plot(folder, "peel", table, R"gp(
set title "Load that takes a plate off a 20 mm cup at 60 kPa (V-B4): measured (points), V r / (x + r) (line)"
set xlabel "mass centre beside the cup, mm"
set ylabel "m (g + a), N"
set yrange [0:20]
plot file using (curve("peel", 2)):4 with lines lt 1 notitle, file using (curve("peel", 2)):3 with points lt 2 notitle
)gp");
  return "peel";
}

}  // namespace

bool plot_suction(const std::string& folder) {
  const std::vector<std::string> names = {plot_pull_off(folder), plot_peel(folder)};
  return draw_plots(folder, names);
}

}  // namespace binpick

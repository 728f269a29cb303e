// Shares of V-E1 to V-E3 over the shape of the solid, beside theory and dice.
#include <cmath>
#include <numbers>

#include "tools/validate/physics_bench.hpp"
#include "tools/validate/plot.hpp"

namespace binpick {
namespace {

/// The number after `words` in a line's text; NaN when it is another line.
double number_after(const std::string& text, const std::string& words) {
  if (text.rfind(words, 0) != 0) return std::nan("");
  return std::stod(text.substr(words.size()));
}

std::string plot_cuboids(const std::vector<Verdict>& lines, const std::string& folder) {
  CurveTable table("curve,ratio,share,low,high");
  const auto ratio_of = [](const Verdict& line) { return number_after(line.what, "cuboid x/y "); };
  const auto theory = [](double ratio) { return 2 / std::numbers::pi * std::asin(1 / (1 + ratio * ratio)); };
  for (const Verdict& line : lines)
    if (!std::isnan(ratio_of(line)))
      table.add(line.id == "V-E3" ? "thrown" : "laid down", {ratio_of(line), line.value, line.low, line.high});
  for (double ratio = 0.3; ratio < 2.81; ratio += 0.05)
    table.add("quasi-static theory", {ratio, theory(ratio), NAN, NAN});
  for (const Verdict& line : lines)  // between theory and dice: the middle is expected
    if (line.id == "V-E3" && !std::isnan(ratio_of(line)))
      table.add("steel dice", {ratio_of(line), 2 * line.expected - theory(ratio_of(line)), NAN, NAN});
  write_plot(folder, "cuboids", table, R"gp(
set title "Cuboids with square ends (V-E2, V-E3): share that comes to rest on a square end"
set xlabel "length over edge of the square, x / y"
set ylabel "P(square end)"
set yrange [0:1]
plot file using (curve("quasi-static theory", 2)):3 with lines title "quasi-static theory", \
  file using (curve("steel dice", 2)):3 with linespoints title "real steel dice", \
  file using (curve("thrown", 2)):3:4:5 with yerrorbars title "thrown, 95 %", \
  file using (curve("laid down", 2)):3:4:5 with yerrorbars title "laid down, 95 %"
)gp");
  return "cuboids";
}

std::string plot_cylinders(const std::vector<Verdict>& lines, const std::string& folder) {
  CurveTable table("curve,ratio,share,low,high");
  for (const Verdict& line : lines) {
    const double eta = number_after(line.what, "cylinder h/D ");
    if (!std::isnan(eta)) table.add("laid down", {eta, line.value, line.low, line.high});
  }
  for (double eta = 0.1; eta < 0.705; eta += 0.02) table.add("theory", {eta, eta / std::sqrt(1 + eta * eta), NAN, NAN});
  write_plot(folder, "cylinders", table, R"gp(
set title "Cylinders laid down (V-E1): share that comes to rest on the side"
set xlabel "height over diameter"
set ylabel "P(side)"
set key top left
plot file using (curve("theory", 2)):3 with lines title "quasi-static theory", \
  file using (curve("laid down", 2)):3:4:5 with yerrorbars title "laid down, 95 %"
)gp");
  return "cylinders";
}

}  // namespace

bool plot_physics(const std::vector<Verdict>& lines, const std::string& folder) {
  const std::vector<std::string> names = {plot_cuboids(lines, folder), plot_cylinders(lines, folder)};
  return draw_plots(folder, names);
}

}  // namespace binpick

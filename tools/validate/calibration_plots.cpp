#include "tools/validate/calibration_plots.hpp"

#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "tools/validate/plot.hpp"

namespace binpick {
namespace {

constexpr double kDegree = 57.29577951308232;
constexpr CalibrationMethod kChain = CalibrationMethod::kChain, kPark = CalibrationMethod::kPark;

struct Calibrations {
  const Cell& cell;
  CalibrationErrors errors;
  std::uint64_t first_seed;
  int draws;
};

std::optional<CalibrationSetup> reachable(const Cell& cell, const CalibrationPlaces& places) {
  try {
    return calibration_setup(cell, places);
  } catch (const SpecError&) {
    return std::nullopt;
  }
}

/// A point of a curve: root mean squares of the draws, and to first order.
void add(CurveTable& table, CalibrationMethod method, double x, const CalibrationSpread& drawn,
         const PredictedError& linear) {
  table.add(to_string(method), {x, 1e3 * drawn.shift, kDegree * drawn.turn, 1e3 * linear.shift, kDegree * linear.turn});
}

void add(CurveTable& table, CalibrationMethod method, double x, const Calibrations& all,
         const CalibrationSetup& setup) {
  add(table, method, x, calibration_spread(setup, all.errors, method, all.first_seed, all.draws),
      predicted_error(setup, all.errors, method));
}

/// Shift on the left, turn on the right; points drawn, lines to first order.
std::string two_panels(const std::string& title, const std::string& x_label) {
  std::string text = "set multiplot layout 1,2 title \"" + title + "\"\nset xlabel \"" + x_label +
                     "\"\nset yrange [0:]\nset offsets 0, 0, graph 0.3, 0\nset key top left\n";
  for (const bool turn : {false, true}) {
    text += std::string("set ylabel \"") + (turn ? "turn, deg" : "shift, mm") + "\"\nplot ";
    for (const char* method : {"chain", "park"}) {
      const std::string name = method, color = name == "chain" ? "2" : "1";
      const std::string of = " file using (curve(\"" + name + "\", 2)):";
      text += std::string(name == "chain" ? "" : ",") + of + (turn ? "6" : "5") + " with lines lt " + color +
              " title \"" + name + ", to first order\"," + of + (turn ? "4" : "3") + " with points lt " + color +
              " title \"" + name + ", drawn\"";
    }
    text += "\n";
  }
  return text + "unset multiplot\n";
}

constexpr const char* kHeader = "curve,x,shift_mm,turn_deg,shift_linear_mm,turn_linear_deg";

std::string over_corner_noise(const Calibrations& all, const std::string& folder) {
  CurveTable table(kHeader);
  const CalibrationSetup setup = calibration_setup(all.cell, {});
  for (const CalibrationMethod method : {kChain, kPark}) {
    CalibrationErrors errors = all.errors, pixel = no_errors();
    errors.corner = 0, pixel.corner = 1;
    // To first order squares add up, and a part of them goes with the square of the noise.
    const PredictedError rest = predicted_error(setup, errors, method), one = predicted_error(setup, pixel, method);
    for (const double noise : {0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0}) {
      errors.corner = noise;
      add(table, method, noise, calibration_spread(setup, errors, method, all.first_seed, all.draws),
          {std::hypot(rest.shift, noise * one.shift), std::hypot(rest.turn, noise * one.turn), 0});
    }
  }
  write_plot(folder, "calibration_corner_noise", table,
             two_panels("Camera on the flange: error over corner noise, other sources as they are",
                        "corner noise, px (one standard deviation)"));
  return "calibration_corner_noise";
}

std::string over_poses(const Calibrations& all, const std::string& folder) {
  CurveTable table(kHeader);
  for (const CalibrationMethod method : {kPark, kChain})  // the chain knows nothing of them: a level to compare with
    for (const int poses : {3, 4, 6, 9, 15, 25})
      if (const auto setup = reachable(all.cell, {.poses = poses})) add(table, method, poses, all, *setup);
  write_plot(
      folder, "calibration_poses", table,
      "set logscale x 2\n" + two_panels("Camera on the flange: error over the number of looks (the chain has two)",
                                        "looks of the hand-eye calibration"));
  return "calibration_poses";
}

std::string over_range(const Calibrations& all, const std::string& folder) {
  CurveTable table(kHeader);
  for (const double above : {0.8, 0.95, 1.1, 1.25, 1.4, 1.6, 1.8})
    if (const auto setup = reachable(all.cell, {.poses = 0, .above = above})) add(table, kChain, above, all, *setup);
  for (const double nearest : {0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6})
    if (const auto setup = reachable(all.cell, {.nearest = nearest})) add(table, kPark, nearest + 0.075, all, *setup);
  write_plot(
      folder, "calibration_range", table,
      two_panels(
          "Camera on the flange: error over range (chain: fixed camera over the floor; park: looks from the plate)",
          "range, m"));
  return "calibration_range";
}

std::string by_source(const Calibrations& all, const std::string& folder) {
  const CalibrationSetup setup = calibration_setup(all.cell, {});
  CurveTable table("curve,method,shift_mm,tip_mm");
  std::string names, shifts, tips;
  for (std::size_t k = 0; k < kErrorSources.size(); ++k) {
    const std::string name = to_string(kErrorSources[k]), place = std::to_string(0.1 * static_cast<double>(k) - 0.25);
    for (const CalibrationMethod method : {kChain, kPark}) {
      const CalibrationSpread s =
          calibration_spread(setup, only(all.errors, kErrorSources[k]), method, all.first_seed, all.draws);
      table.add(name, {method == kChain ? 1.0 : 2.0, 1e3 * s.shift, 1e3 * s.tip});
    }
    const std::string use = std::string(k == 0 ? "plot" : ",") + " file using (curve(\"" + name + "\", 2) + " + place;
    const std::string look = ":(0.09) with boxes lt " + std::to_string(k + 1) + " title \"" + name + "\"";
    shifts += use + "):3" + look;
    tips += use + "):4" + look;
  }
  write_plot(folder, "calibration_sources", table,
             "set multiplot layout 1,2 title \"One source of error at a time: root mean square\"\n"
             "set style fill solid 0.8\nset xrange [0.5:2.5]\nset yrange [0:]\nset offsets 0, 0, graph 0.3, 0\nset "
             "xtics (\"chain\" 1, \"park\" 2)\n"
             "set ylabel \"shift of the camera, mm\"\n" +
                 shifts + "\nunset key\nset ylabel \"tip at a part, mm\"\n" + tips + "\nunset multiplot\n");
  return "calibration_sources";
}

}  // namespace

bool plot_calibration(const Cell& cell, const CalibrationErrors& errors, std::uint64_t first_seed, int draws,
                      const std::string& folder) {
  const Calibrations all{cell, errors, first_seed, draws};
  return draw_plots(folder, {over_corner_noise(all, folder), over_poses(all, folder), over_range(all, folder),
                             by_source(all, folder)});
}

}  // namespace binpick

// Curves of shapes and offsets: the shadow beside a step, the correlation of the noise, the error of a bias.

#include <cmath>

#include "sim/sensors/camera_table.hpp"
#include "tools/validate/plot.hpp"
#include "tools/validate/sensor_plots.hpp"

namespace binpick {

std::string plot_shadow(SensorBench& bench, const std::string& folder) {
  constexpr double kPlate = 0.45;
  CurveTable table("camera,step_mm,measured_px,expected_px");
  for (const PlotSubject& subject :
       {PlotSubject{"disparity", "d415_1280", 2}, PlotSubject{"disparity", "d435_1280", 2},
        PlotSubject{"disparity", "d435_848", 2}, PlotSubject{"active_stereo", "d435_848", 2}}) {
    const auto sensor = subject.make();
    const DepthCamera& row = depth_camera(subject.preset);
    for (const double step : {0.01, 0.02, 0.03, 0.05, 0.075, 0.10, 0.15, 0.20}) {
      const BenchView view = bench.step(*sensor, kPlate, kPlate + step, 0, subject.matches_views());
      const double expected = row.fB() * (1 / kPlate - 1 / (kPlate + step));
      double width = 0;
      for (int k = 0; k < subject.frames; ++k)
        width += missing_left_of_plate(view, bench.shoot(*sensor, view, k), kPlate, expected) / subject.frames;
      table.add(subject.name(), {1e3 * step, width, expected});
    }
  }
  write_plot(folder, "shadow_over_step", table, R"gp(
set title "Shadow on the left of a plate at 450 mm: all terms on (points), f B (1/z near - 1/z far) (lines)"
set xlabel "depth of the step, mm"
set ylabel "missing pixels in a row"
set xrange [0:210]
set yrange [0:*]
set key top left
array camera[3] = ["d415_1280", "d435_1280", "d435_848"]
plot for [i=1:3] file using (curve(camera[i], 2)):4 with lines lt i lw 1.5 notitle, \
  for [i=1:3] file using (curve(camera[i], 2)):3 with points lt i title "disparity ".camera[i], \
  file using (curve("active_stereo d435_848", 2)):3 with points lt 3 pt 6 ps 1.8 title "active_stereo d435_848"
)gp");
  return "shadow_over_step";
}

std::string plot_correlation(SensorBench& bench, const std::string& folder) {
  CurveTable table("model,lag_px,correlation");
  for (const PlotSubject& subject : {PlotSubject{"disparity", "d435_848", 8}, PlotSubject{"gauss_z", "d435_848", 2},
                                     PlotSubject{"active_stereo", "d435_848", 3}}) {
    const auto sensor = subject.make();
    const BenchView view = bench.wall(*sensor, 0.7, 0, subject.matches_views());
    std::vector<Image<float>> frames;
    for (int k = 0; k < subject.frames; ++k) frames.push_back(bench.shoot(*sensor, view, k));
    for (int lag = 0; lag <= 15; ++lag) {
      double mean = 0;
      for (const Image<float>& depth : frames)
        mean += error_correlation(depth, view.exact.depth, view.centre, lag) / subject.frames;
      table.add(subject.type, {static_cast<double>(lag), mean});
    }
  }
  write_plot(folder, "noise_correlation", table, R"gp(
set title "How far the noise hangs together: wall at 0.7 m, D435 848 x 480, along a row"
set xlabel "lag, px"
set ylabel "autocorrelation of the depth error"
set xrange [0:15]
set yrange [-0.2:1.05]
set key top right
plot exp(-x**2 / 25) with lines lt 1 dt 2 title "exp(-k^2 / (4 l^2)), l = 2.5 px: the field of disparity alone", \
  0 with lines lt 9 lw 1 notitle, \
  file using (curve("disparity", 2)):3 with linespoints lt 1 title "disparity", \
  file using (curve("active_stereo", 2)):3 with linespoints lt 2 title "active_stereo", \
  file using (curve("gauss_z", 2)):3 with linespoints lt 9 title "gauss_z"
)gp");
  return "noise_correlation";
}

std::string plot_bias(SensorBench& bench, const std::string& folder) {
  CurveTable table("bias_px,z_m,measured_mm,expected_mm");
  const double fB = depth_camera("d435_848").fB();
  for (const char* bias : {"0.4", "0.1", "-0.1", "-0.4"}) {
    const auto sensor =
        configured_sensor("disparity", std::string("preset: d435_848\nbias_sigma: 0\nbias_mean: ") + bias + "\n");
    for (const double z : {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.4}) {
      const BenchView view = bench.wall(*sensor, z, 0.05);
      const double error = mean_error(bench.shoot(*sensor, view, 0), view.exact.depth, view.centre);
      table.add(bias, {z, 1e3 * error, 1e3 * (fB / (fB / z + std::stod(bias)) - z)});
    }
  }
  write_plot(folder, "bias_over_range", table, R"gp(
set title "Mean depth error of a disparity bias, D435 848 x 480: all terms on (points), f B / (d + dd) - z (lines)"
set xlabel "range z, m"
set ylabel "mean error, mm"
set xrange [0.25:1.45]
set key top left
array bias[4] = ["-0.4", "-0.1", "0.1", "0.4"]
plot for [i=1:4] file using (curve(bias[i], 2)):4 with lines lt i lw 1.5 notitle, \
  for [i=1:4] file using (curve(bias[i], 2)):3 with points lt i title "bias ".bias[i]." px", \
  "+" using (1.0):(-19.3) every ::0::0 with points lt 9 pt 2 ps 2.5 title "a D435 out of the box: 980.7 mm at 1 m"
)gp");
  return "bias_over_range";
}

}  // namespace binpick

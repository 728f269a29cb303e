#include "tools/validate/sensor_plots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/sensors/camera_table.hpp"
#include "tools/validate/plot.hpp"

namespace binpick {
namespace {

const double kNone = std::numeric_limits<double>::quiet_NaN();

using Measure = std::function<double(const BenchView&, const Image<float>&)>;

double mean_over_frames(SensorBench& bench, const PlotSubject& subject, const SensorModel& sensor,
                        const BenchView& view, const Measure& measure) {
  std::vector<double> values;
  for (int k = 0; k < subject.frames; ++k) values.push_back(measure(view, bench.shoot(sensor, view, k)));
  return mean_of(values);
}

// The published standard deviation of a camera at z (physical_models A1, A2), m.
double published_sigma(const std::string& preset, double z) {
  if (preset == "kinect_v1") return 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
  if (preset == "azure_kinect") return 0.0005 + 0.001 * std::max(z - 0.5, 0.0);
  if (preset == "zivid_2") return std::abs(z - 0.70) < 0.01 ? 0.055e-3 : kNone;  // stated at one range
  if (preset == "phoxi_m") return std::abs(z - 0.65) < 0.01 ? 0.10e-3 : kNone;
  return z * z * 0.08 / depth_camera(preset).fB();
}

constexpr char kNoiseScript[] = R"gp(
set title "Noise of a flat wall: measured (points), published laws (lines; crosses: one stated value)"
set label 1 "Kinect and Azure deliver whole millimetres: that alone is 0.29 mm" at graph 0.02, 0.03 font ",11"
set logscale xy
set xlabel "range z, m"
set ylabel "plane-fit RMS, mm"
set xrange [0.18:2]
set yrange [0.01:20]
set xtics (0.2, 0.3, 0.5, 0.7, 1, 1.5, 2)
set key outside right top
array light[3] = ["active_stereo d435_848", "structured_light zivid_2", "structured_light phoxi_m"]
array same[3] = [2, 9, 10]
array camera[10] = ["d415_1280", "d435_848", "d435_1280", "d405_848", "d405_1280", "d455_848", \
  "kinect_v1", "azure_kinect", "zivid_2", "phoxi_m"]
plot for [i=1:8] file using (curve(camera[i], 2)):4 with lines lt i lw 1.5 notitle, \
  for [i=9:10] file using (curve(camera[i], 2)):4 with points lt i pt 2 ps 3 notitle, \
  for [i=1:10] file using (curve(camera[i], 2)):3 with points lt i title camera[i], \
  for [i=1:3] file using (curve(light[i], 2)):3 with points lt same[i] pt 6 ps 1.8 title light[i]
)gp";

}  // namespace

std::string plot_noise(SensorBench& bench, const std::string& folder) {
  const PlotSubject subjects[] = {{"disparity", "d415_1280"},
                                  {"disparity", "d435_848"},
                                  {"disparity", "d435_1280"},
                                  {"disparity", "d405_848"},
                                  {"disparity", "d405_1280"},
                                  {"disparity", "d455_848"},
                                  {"active_stereo", "d435_848", 1},
                                  {"gauss_z", "kinect_v1"},
                                  {"gauss_z", "azure_kinect"},
                                  {"gauss_z", "zivid_2"},
                                  {"gauss_z", "phoxi_m"},
                                  {"structured_light", "zivid_2", 1},
                                  {"structured_light", "phoxi_m", 1}};
  CurveTable table("camera,z_m,measured_mm,published_mm");
  for (const PlotSubject& subject : subjects) {
    const auto sensor = subject.make();
    for (const double z : {0.2, 0.3, 0.4, 0.5, 0.65, 0.7, 0.85, 1.0, 1.2, 1.5, 1.8}) {
      if (z < 1.02 * sensor->z_min() || z > 0.95 * sensor->z_max()) continue;
      const BenchView view = bench.wall(*sensor, z, 0, subject.matches_views());
      const double rms = mean_over_frames(bench, subject, *sensor, view, [](const BenchView& v, const Image<float>& d) {
        return plane_fit_rms(d, v.camera, v.centre);
      });
      table.add(subject.name(), {z, 1e3 * rms, 1e3 * published_sigma(subject.preset, z)});
    }
  }
  write_plot(folder, "noise_over_range", table, kNoiseScript);
  return "noise_over_range";
}

std::string plot_subpixel(SensorBench& bench, const std::string& folder) {
  CurveTable table("model,z_m,subpixel_rms_px");
  for (const PlotSubject& subject :
       {PlotSubject{"disparity", "d435_848", 4}, PlotSubject{"active_stereo", "d435_848"}}) {
    const auto sensor = subject.make();
    for (const double z : {0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0, 1.2, 1.5, 1.8}) {
      const BenchView view = bench.wall(*sensor, z, 0, subject.matches_views());
      table.add(subject.type,
                {z, mean_over_frames(bench, subject, *sensor, view, [](const BenchView& v, const Image<float>& d) {
                   return subpixel_rms(d, v.camera, v.centre, depth_camera("d435_848").baseline);
                 })});
    }
  }
  write_plot(folder, "subpixel_noise", table, R"gp(
set title "Subpixel RMS on a flat Lambertian wall, D435 848 x 480"
set xlabel "range z, m"
set ylabel "subpixel RMS, px"
set xrange [0.2:1.9]
set yrange [0:0.16]
set key top left
set object 1 rectangle from graph 0, first 0.05 to graph 1, first 0.1 fc rgb "#eeeeee" fs solid noborder behind
set label 1 "usually quoted: 0.05 .. 0.1 px" at graph 0.98, first 0.096 right font ",11"
plot 0.08 with lines lt 9 dt 2 title "practical default, 0.08 px", 0.032 with lines lt 3 dt 2 title "best case, 0.032 px", \
  file using (curve("disparity", 2)):3 with linespoints lt 1 title "disparity", \
  file using (curve("active_stereo", 2)):3 with linespoints lt 2 title "active_stereo"
)gp");
  return "subpixel_noise";
}

std::string plot_averaging(SensorBench& bench, const std::string& folder) {
  CurveTable table("model,frames,ratio");
  for (const PlotSubject& subject : {PlotSubject{"disparity", "d435_848", 6}, PlotSubject{"gauss_z", "d435_848", 2},
                                     PlotSubject{"active_stereo", "d435_848", 1}}) {
    const auto sensor = subject.make();
    const BenchView view = bench.wall(*sensor, 0.7, 0, subject.matches_views());
    const auto rms = [&](const Image<float>& d) { return plane_fit_rms(d, view.camera, view.centre); };
    std::vector<double> one, many[6];
    for (int k = 0; k < subject.frames; ++k) {
      std::vector<Image<float>> film;
      for (int frame = 0; frame < 32; ++frame) {
        film.push_back(bench.shoot(*sensor, view, k, frame));
        one.push_back(rms(film.back()));
        for (int power = 0; power < 6; ++power)
          if (frame + 1 == 1 << power) many[power].push_back(rms(frame_mean(film)));
      }
    }
    for (int power = 0; power < 6; ++power)
      table.add(subject.type, {std::pow(2.0, power), mean_of(many[power]) / mean_of(one)});
  }
  write_plot(folder, "temporal_averaging", table, R"gp(
set title "What averaging over time can do: wall at 0.7 m, D435 848 x 480"
set logscale xy
set xlabel "frames averaged"
set ylabel "plane-fit RMS of the mean / of one frame"
set xrange [0.9:36]
set yrange [0.15:1.15]
set xtics (1, 2, 4, 8, 16, 32)
set ytics (0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1)
set key bottom left
plot 1/sqrt(x) with lines lt 9 dt 2 title "1/sqrt(n): white noise", \
  sqrt(0.5 + 0.5/x) with lines lt 1 dt 2 title "sqrt(0.5 + 0.5/n): half of the variance is fixed", \
  file using (curve("gauss_z", 2)):3 with points lt 9 title "gauss_z", \
  file using (curve("disparity", 2)):3 with points lt 1 title "disparity", \
  file using (curve("active_stereo", 2)):3 with linespoints lt 2 title "active_stereo"
)gp");
  return "temporal_averaging";
}

bool plot_sensors(SensorBench& bench, const std::string& folder) {
  std::vector<std::string> names;
  for (std::string (*plot)(SensorBench&, const std::string&) :
       {plot_noise, plot_subpixel, plot_shadow, plot_correlation, plot_averaging, plot_bias})
    names.push_back(plot(bench, folder));
  return draw_plots(folder, names);
}

}  // namespace binpick

// V-A1, V-A2, V-A3 and V-A6: how large the noise is, how it grows with range, how it hangs together in space and time.

#include <cmath>
#include <cstdio>

#include "sim/sensors/camera_table.hpp"
#include "tools/validate/sensor_bench.hpp"

namespace binpick {
namespace {

constexpr double kLength = 2.5;  // px, correlation length of the noise
constexpr double kPixel = 0.08;  // px, its standard deviation s
constexpr double kDegree = M_PI / 180;

std::string at_range(const std::string& camera, double z, const char* what) {
  char text[96];
  std::snprintf(text, sizeof text, "%s, wall at %.3g m: %s", camera.c_str(), z, what);
  return text;
}

double plane_rms(SensorBench& bench, const SensorModel& sensor, const BenchView& view) {
  return mean_of(bench.each_seed(
      sensor, view, [&](const Image<float>& depth) { return plane_fit_rms(depth, view.camera, view.centre); }));
}

void wall_rms_at_three_ranges(SensorBench& bench, const std::string& camera) {
  const auto sensor = noise_only_disparity(camera);
  for (const double z : {0.5, 0.7, 1.0}) {
    const BenchView view = bench.wall(*sensor, z);
    const double expected = z * z * kPixel / depth_camera(camera).fB();  // sigma_z = z^2 s / (f B)
    bench.verdicts().push_back({"V-A1", at_range(camera, z, "plane-fit RMS"), plane_rms(bench, *sensor, view), expected,
                                bench.rms_tolerance(0.05, view, kLength) * expected, "m"});
  }
}

// Slope of log y over log x by least squares, and its standard error when every y is known to `relative`.
struct LogSlope {
  std::vector<double> x, y;
  void add(double range, double value) { x.push_back(std::log(range)), y.push_back(std::log(value)); }
  double spread() const {
    double sum = 0;
    for (const double a : x) sum += (a - mean_of(x)) * (a - mean_of(x));
    return sum;
  }
  double slope() const {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - mean_of(x)) * y[i];
    return sum / spread();
  }
  double error(double relative) const { return relative / std::sqrt(spread()); }
};

void growth_with_range(SensorBench& bench) {
  const std::string camera = "d435_848";
  const auto sensor = noise_only_disparity(camera);
  LogSlope fit;
  int pixels = 1;
  for (const double z : {0.4, 0.6, 0.9, 1.35, 2.0}) {
    const BenchView view = bench.wall(*sensor, z);
    pixels = view.centre.pixels();
    fit.add(z, plane_rms(bench, *sensor, view));
    const double s = mean_of(bench.each_seed(*sensor, view, [&](const Image<float>& depth) {
      return subpixel_rms(depth, view.camera, view.centre, depth_camera(camera).baseline);
    }));
    bench.verdicts().push_back({"V-A2", at_range(camera, z, "subpixel RMS"), s, kPixel,
                                bench.rms_tolerance(0.03, view, kLength) * kPixel, "px"});
  }
  const double own = fit.error(rms_standard_error(pixels, kLength, bench.seeds()));
  const double full = fit.error(rms_standard_error(pixels, kLength, SensorBench::kFullSeeds));
  bench.verdicts().push_back({"V-A2", camera + ", 0.4 .. 2 m: log-log slope of the plane-fit RMS", fit.slope(), 2.0,
                              widened(0.05, own, full), "1"});
}

}  // namespace

void check_wall_noise(SensorBench& bench) {
  wall_rms_at_three_ranges(bench, "d435_848");
  wall_rms_at_three_ranges(bench, "d415_1280");
  growth_with_range(bench);
}

void check_kinect_noise(SensorBench& bench) {
  const auto sensor = configured_sensor("gauss_z", "preset: kinect_v1\ndepth_unit: 0.1 mm\n");
  double frontal = 0;
  for (const double z : {0.5, 0.7, 1.0}) {
    const BenchView view = bench.wall(*sensor, z);
    const double expected = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);  // Nguyen 2012
    frontal = plane_rms(bench, *sensor, view);
    bench.verdicts().push_back({"V-A3", at_range("kinect_v1", z, "plane-fit RMS"), frontal, expected,
                                bench.rms_tolerance(0.05, view, 0) * expected, "m"});
  }
  // Two columns in the middle: beside them the slanted wall soon has other depths and angles.
  const BenchView view = bench.wall(*sensor, 1.0, 75 * kDegree);
  const ImageRegion middle = centre_region(view.camera, 2, view.centre.v1 - view.centre.v0);
  const double slanted = mean_of(bench.each_seed(
      *sensor, view, [&](const Image<float>& depth) { return rms_error(depth, view.exact.depth, middle); }));
  bench.verdicts().push_back({"V-A3", "kinect_v1, 1 m, 75 deg: RMS error exceeds the frontal wall's", slanted, frontal,
                              0, "m", Verdict::Rule::kAbove});
}

void check_noise_correlation(SensorBench& bench) {
  constexpr int kFrames = 40;
  const double z = 0.7;
  const std::string camera = "d435_848";
  const auto sensor = noise_only_disparity(camera);
  const BenchView view = bench.wall(*sensor, z);
  const ImageRegion region =
      centre_region(view.camera, 2 * (view.centre.u1 - view.centre.u0), 2 * (view.centre.v1 - view.centre.v0));
  const Image<float>& truth = view.exact.depth;
  double lag1 = 0, lag8 = 0, single = 0, averaged = 0, temporal = 0;
  for (int k = 0; k < bench.seeds(); ++k) {
    const std::vector<Image<float>> film = bench.film(*sensor, view, k, kFrames);
    for (const Image<float>& frame : film) {
      lag1 += error_correlation(frame, truth, region, 1) / (kFrames * bench.seeds());
      lag8 += error_correlation(frame, truth, region, 8) / (kFrames * bench.seeds());
      single += std::pow(rms_error(frame, truth, region), 2) / kFrames;
    }
    averaged += std::pow(rms_error(frame_mean(film), truth, region), 2);
    temporal += temporal_noise(film, view.centre) / bench.seeds();
  }
  // Only the fixed share of the noise, drawn once a camera, is known badly: RMS to `own`. It makes up half of the
  // variance of a single frame and nearly all of the averaged one, so that the ratio is known to half of that.
  const double own = rms_standard_error(region.pixels(), kLength, bench.seeds());
  const double full = rms_standard_error(region.pixels(), kLength, SensorBench::kFullSeeds);
  auto& out = bench.verdicts();
  out.push_back(
      {"V-A6", camera + ": noise correlation of neighbours (lag 1)", lag1, 0.7, 0, "1", Verdict::Rule::kAbove});
  // A correlation near 0 is known to sqrt(2) times the relative error of an RMS.
  out.push_back({"V-A6", camera + ": noise correlation at lag 8", lag8, 0.1, widened(0, M_SQRT2 * own, M_SQRT2 * full),
                 "1", Verdict::Rule::kBelow});
  out.push_back({"V-A6", camera + ": RMS of the mean of 40 frames / RMS of one", std::sqrt(averaged / single), 0.72,
                 widened(0.02, 0.36 * own, 0.36 * full), "1"});
  // Half of the variance changes from frame to frame; sigma_z / z = z s / (f B).
  const double expected = std::sqrt(0.5) * z * kPixel / depth_camera(camera).fB();
  out.push_back({"V-A6", at_range(camera, z, "temporal noise of 40 frames"), temporal, expected,
                 widened(0.03, own, full) * expected, "m/m"});
}

}  // namespace binpick

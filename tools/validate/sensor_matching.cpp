// V-A7: the model that matches two rendered views against the model that makes the noise in the disparity domain, on
// the same walls and the same step.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/sensors/camera_table.hpp"
#include "tools/validate/sensor_bench.hpp"

namespace binpick {
namespace {

constexpr double kHalfWindow = 3.5;  // px, matching window of 7 x 7
const char* const kPreset = "d435_848";

void walls(SensorBench& bench, const std::string& type, const SensorModel& sensor) {
  const std::vector<double> ranges = {0.5, 0.7, 1.0};
  const int frames = bench.quick() ? 1 : 5;
  double fill = 1;
  for (const double z : ranges) {
    const BenchView view = bench.wall(sensor, z, 0, true);
    std::vector<double> s;
    for (int k = 0; k < frames; ++k) {
      const Image<float> depth = bench.shoot(sensor, view, k);
      s.push_back(subpixel_rms(depth, view.camera, view.centre, depth_camera(kPreset).baseline));
      fill = std::min(fill, fill_rate(depth, view.centre));
    }
    char what[96];
    std::snprintf(what, sizeof what, "%s, wall at %.3g m: subpixel RMS", type.c_str(), z);
    bench.verdicts().push_back({"V-A7", what, mean_of(s), 0.075, 0.045, "px"});
  }
  bench.verdicts().push_back(
      {"V-A7", type + ", Lambertian wall: smallest fill", fill, 0.98, 0, "1", Verdict::Rule::kAbove});
}

void step(SensorBench& bench, const std::string& type, const SensorModel& sensor) {
  constexpr double kPlate = 0.45, kWall = 0.50;
  const DepthCamera& row = depth_camera(kPreset);
  const BenchView view = bench.step(sensor, kPlate, kWall, 0, true);
  const double expected = row.fB() * (1 / kPlate - 1 / kWall);
  const int frames = bench.quick() ? 1 : 5;
  std::vector<double> widths;
  for (int k = 0; k < frames; ++k)
    widths.push_back(missing_left_of_plate(view, bench.shoot(sensor, view, k), kPlate, expected));
  bench.verdicts().push_back(
      {"V-A7", type + ", step 450/500 mm: shadow width", mean_of(widths), expected, kHalfWindow, "px"});
}

}  // namespace

void check_matching(SensorBench& bench) {
  for (const std::string type : {"disparity", "active_stereo"}) {
    const auto sensor = configured_sensor(type, std::string("preset: ") + kPreset + "\n");
    walls(bench, type, *sensor);
    step(bench, type, *sensor);
  }
}

}  // namespace binpick

// V-A4, V-A5 and V-A8: the shadow beside a step, the steps of depth, and what a disparity bias does to it.

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "sim/sensors/camera_table.hpp"
#include "tools/validate/sensor_bench.hpp"

namespace binpick {
namespace {

struct Holes {
  double left = 0, right = 0;  // px a row, beside the plate's left and right outline
};

// Missing pixels on the wall's side of both outlines, out to the edge of what the second imager sees.
Holes holes_beside_plate(const BenchView& view, const Image<float>& depth, double wall_disparity) {
  const int first = static_cast<int>(std::ceil(wall_disparity)) + 1, middle = view.camera.width / 2;
  Holes holes;
  const double rows = view.centre.v1 - view.centre.v0;
  for (int v = view.centre.v0; v < view.centre.v1; ++v)
    for (int u = first; u < view.camera.width; ++u)
      if (std::isnan(depth(u, v))) (u < middle ? holes.left : holes.right) += 1 / rows;
  return holes;
}

void shadow_of_step(SensorBench& bench, const std::string& preset) {
  constexpr double kPlate = 0.45, kWall = 0.50;
  constexpr int kShifts = 8;  // the outline in eight places within a pixel
  const auto sensor = bare_disparity(preset, "occlusion: true\n");
  const DepthCamera& row = depth_camera(preset);
  Holes mean;
  for (int i = 0; i < kShifts; ++i) {
    const BenchView view = bench.step(*sensor, kPlate, kWall, i * kPlate / row.camera.fx / kShifts);
    const Holes holes = holes_beside_plate(view, bench.shoot(*sensor, view, 0), row.fB() / kWall);
    mean.left += holes.left / kShifts;
    mean.right += holes.right / kShifts;
  }
  const double expected = row.fB() * (1 / kPlate - 1 / kWall);  // w = f B (1/z_near - 1/z_far)
  bench.verdicts().push_back({"V-A4", preset + ", step 450/500 mm: hole on the left", mean.left, expected, 1, "px"});
  bench.verdicts().push_back({"V-A4", preset + ", step 450/500 mm: hole on the right", mean.right, 0, 0, "px"});
}

// Mean distance of neighbouring output depths within 20 mm of 1 m, each divided by z^2.
double step_at_one_metre(SensorBench& bench, const SensorModel& sensor) {
  const BenchView view = bench.wall(sensor, 1.0, 0.3);
  std::set<float> values;
  for (const float z : bench.shoot(sensor, view, 0))
    if (std::abs(z - 1.0f) < 0.02f) values.insert(z);
  if (values.size() < 20) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> steps;
  for (auto it = values.begin(), next = std::next(it); next != values.end(); ++it, ++next)
    steps.push_back((*next - *it) / std::pow(0.5 * (*it + *next), 2));
  return mean_of(steps);
}

// Share of the pixels nearer than z_min (by more than the noise and the jitter can reach) that get a depth below it.
double share_below_z_min(SensorBench& bench) {
  const auto sensor = configured_sensor("disparity", "preset: d435_848\n");
  const BenchView view = bench.wall(*sensor, sensor->z_min(), 0.4);
  int nearer = 0, below = 0;
  const Image<float> depth = bench.shoot(*sensor, view, 0);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    nearer += view.exact.depth[i] < sensor->z_min();
    below += depth[i] < static_cast<float>(sensor->z_min());
  }
  return nearer < 1000 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(below) / nearer;
}

double error_with_bias(SensorBench& bench, const char* bias) {
  const auto sensor = bare_disparity("d435_848", std::string("bias_mean: ") + bias + "\n");
  const BenchView view = bench.wall(*sensor, 1.0, 0.05);  // leaning, so that the steps of depth average out
  return mean_error(bench.shoot(*sensor, view, 0), view.exact.depth, view.centre);
}

}  // namespace

void check_shadow(SensorBench& bench) {
  for (const char* preset : {"d415_1280", "d435_848", "d435_1280"}) shadow_of_step(bench, preset);
}

void check_depth_steps(SensorBench& bench) {
  const auto sensor = bare_disparity("d435_848", "depth_unit: 0\n");
  const double expected = 1 / (32 * depth_camera("d435_848").fB());  // dz = z^2 / (32 f B)
  bench.verdicts().push_back({"V-A5", "d435_848, leaning wall: step of the depth at 1 m",
                              step_at_one_metre(bench, *sensor), expected, 0.01 * expected, "m"});
  bench.verdicts().push_back(
      {"V-A5", "d435_848, wall through z_min: share delivered below it", share_below_z_min(bench), 0, 0, "1"});
}

void check_bias(SensorBench& bench) {
  const double nearer = error_with_bias(bench, "0.4"), farther = error_with_bias(bench, "-0.4");
  const double fB = depth_camera("d435_848").fB();
  const double first_order = 0.4 / fB;  // dz = z^2 dd / (f B)
  auto& out = bench.verdicts();
  out.push_back({"V-A8", "d435_848, wall at 1 m, bias of 0.4 px: half of the difference of both signs",
                 0.5 * (farther - nearer), first_order, 0.02 * first_order, "m"});
  // The second order is 2 % here: z - f B / (d + dd).
  const double near_exact = fB / (fB + 0.4) - 1, far_exact = fB / (fB - 0.4) - 1;
  out.push_back({"V-A8", "bias +0.4 px: mean error", nearer, near_exact, 0.02 * first_order, "m"});
  out.push_back({"V-A8", "bias -0.4 px: mean error", farther, far_exact, 0.02 * first_order, "m"});
}

}  // namespace binpick

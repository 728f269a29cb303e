#include "tools/bench/sensor_bench.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>

#include "sim/depth_sensor.hpp"

namespace binpick {
namespace {

double milliseconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double processor_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Limits and aims for 848 x 480 pixels, 40 parts of 5,000 triangles and two cores.
const std::map<std::string, std::pair<double, double>> kTargets = {
    {"ideal", {30, 10}}, {"disparity", {50, 18}}, {"active_stereo", {600, 300}}, {"structured_light", {1000, 500}}};

struct Runner {
  BenchRow row;
  std::function<void(int)> frame, capture;  // frame number
};

constexpr double kNear = 0.05, kFar = 2.4;

Runner renderer_runner(const std::string& name, DepthRenderer& renderer, const BenchHeap& heap) {
  const auto render = [&](int) { return renderer.render(heap.scene, heap.camera, heap.X_WC, kNear, kFar); };
  return {{"renderer " + name, {}, {}, {}},
          [=](int k) { render(k); },
          [=, &renderer, &heap](int k) {
            const ExactFrame frame = render(k);
            part_visibility(renderer, heap.scene, frame, heap.camera, heap.X_WC, heap.parts);
          }};
}

Runner sensor_runner(const std::string& name, DepthRenderer& renderer, const BenchHeap& heap, int threads) {
  const std::shared_ptr<const SensorModel> sensor = make_sensor(name);
  const auto capture = [&heap, &renderer, sensor, threads](int k, std::size_t parts) {
    const CaptureRequest request{
        heap.camera, heap.X_WC, heap.X_WC, Seed{1}, Seed{2}.child("frame", static_cast<std::uint64_t>(k)), threads};
    capture_depth(renderer, *sensor, heap.scene, parts, request);
  };
  Runner runner{
      {name, {}, {}, {}}, [=](int k) { capture(k, 0); }, [=, parts = heap.parts](int k) { capture(k, parts); }};
  if (const auto target = kTargets.find(name); target != kTargets.end())
    std::tie(runner.row.limit_ms, runner.row.aim_ms) = target->second;
  return runner;
}

}  // namespace

std::vector<BenchRow> bench_sensors(const BenchHeap& heap, const SensorBenchConfig& config) {
  const auto osmesa = make_osmesa_renderer(), raycast = make_raycast_renderer(config.threads);
  std::vector<Runner> runners = {renderer_runner("osmesa", *osmesa, heap), renderer_runner("raycast", *raycast, heap)};
  for (const std::string& name : sensor_names()) runners.push_back(sensor_runner(name, *osmesa, heap, config.threads));
  for (int k = -1; k < config.frames; ++k)  // the first turn uploads meshes and fills caches
    for (Runner& runner : runners) {
      const double frame = milliseconds([&] { runner.frame(std::max(k, 0)); });
      const double processor = processor_milliseconds();
      const double capture = milliseconds([&] { runner.capture(std::max(k, 0)); });
      const double spent = processor_milliseconds() - processor;
      if (k < 0) continue;
      runner.row.frame_ms.push_back(frame);
      runner.row.capture_ms.push_back(capture);
      runner.row.cpu_ms.push_back(spent);
    }
  std::vector<BenchRow> rows;
  for (Runner& runner : runners) rows.push_back(std::move(runner.row));
  return rows;
}

}  // namespace binpick

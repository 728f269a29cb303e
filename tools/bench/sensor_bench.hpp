// Wall time of one frame: the renderers alone and every sensor of the registry, all in turn within the same run, so
// that whatever else the machine does falls on all of them.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/bench_heap.hpp"

namespace binpick {

struct SensorBenchConfig {
  int frames = 20;
  int threads = 2;
};

struct BenchRow {
  std::string name;
  std::vector<double> frame_ms;    ///< exact frame and, for a sensor, its model
  std::vector<double> capture_ms;  ///< the same with the visible fractions, as a trial asks for it
  std::vector<double> cpu_ms;  ///< processor time of the latter, all threads: tells a busy machine from a slow frame
  double limit_ms = 0, aim_ms = 0;  ///< what is asked for; 0: nothing
};

std::vector<BenchRow> bench_sensors(const BenchHeap& heap, const SensorBenchConfig& config);

/// Frames of four trials (heaps, sensors and seeds of their own) made by four threads at once, each with its own
/// renderer and sensors, against the same frames made one by one.
struct ThreadCheck {
  int equal = 0, different = 0;
};
ThreadCheck check_threads(int frames);

}  // namespace binpick

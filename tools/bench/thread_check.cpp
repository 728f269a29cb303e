#include <thread>

#include "core/hash.hpp"
#include "sim/depth_sensor.hpp"
#include "tools/bench/sensor_bench.hpp"

namespace binpick {
namespace {

constexpr int kTrials = 4;
constexpr std::size_t kParts = 12;
constexpr std::uint64_t kFirstSeed = 5000;

// What one worker owns, and its frames: trial t makes frames t, t + 4, ..
class Worker {
 public:
  Worker() {
    for (const std::string& name : sensor_names()) sensors_.push_back(make_sensor(name));
  }

  std::uint64_t frame(const BenchHeap& heap, int trial, int frame) {
    const Seed seed = Seed{kFirstSeed + static_cast<std::uint64_t>(trial)};
    Rng place = seed.child("camera_place", static_cast<std::uint64_t>(frame)).rng();
    const Eigen::Vector3d p(place.uniform(-0.05, 0.05), place.uniform(-0.05, 0.05), place.uniform(0.5, 0.7));
    const Pose X_WC = pose_from_xyz_rpy(p, {M_PI + place.uniform(-0.1, 0.1), place.uniform(-0.1, 0.1), 0});
    const SensorModel& sensor = *sensors_[static_cast<std::size_t>(frame / kTrials) % sensors_.size()];
    const CaptureRequest request{
        heap.camera, X_WC, X_WC, seed.child("unit"), seed.child("frame", static_cast<std::uint64_t>(frame)), 1};
    const Capture capture = capture_depth(*renderer_, sensor, heap.scene, heap.parts, request);
    Hasher hasher;
    hasher.add(frame_hash(capture.frame));
    for (const Visibility& part : capture.visibility)
      hasher.add(std::uint64_t(part.visible_pixels)).add(std::uint64_t(part.silhouette_pixels));
    return hasher.value();
  }

 private:
  std::unique_ptr<DepthRenderer> renderer_ = make_osmesa_renderer();
  std::vector<std::unique_ptr<SensorModel>> sensors_;
};

}  // namespace

ThreadCheck check_threads(int frames) {
  std::vector<BenchHeap> heaps;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) heaps.push_back(bench_heap(kParts, Seed{kFirstSeed + trial}));
  std::vector<std::uint64_t> together(static_cast<std::size_t>(frames)), alone = together;
  std::vector<std::thread> threads;
  for (int trial = 0; trial < kTrials; ++trial)
    threads.emplace_back([&, trial] {
      Worker worker;
      for (int i = trial; i < frames; i += kTrials)
        together[static_cast<std::size_t>(i)] = worker.frame(heaps[static_cast<std::size_t>(trial)], trial, i);
    });
  for (std::thread& thread : threads) thread.join();
  Worker worker;
  ThreadCheck check;
  for (int i = 0; i < frames; ++i) {
    alone[static_cast<std::size_t>(i)] = worker.frame(heaps[static_cast<std::size_t>(i % kTrials)], i % kTrials, i);
    alone[static_cast<std::size_t>(i)] == together[static_cast<std::size_t>(i)] ? ++check.equal : ++check.different;
  }
  return check;
}

}  // namespace binpick

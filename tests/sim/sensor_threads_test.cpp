// Threads, inside a frame and around it, change no bit.
#include <thread>

#include "core/primitive.hpp"
#include "sensor_fixtures.hpp"
#include "sim/depth_sensor.hpp"

namespace binpick {
namespace {

constexpr std::size_t kParts = 8;

// A small heap of its own for every trial.
RenderScene heap(std::uint64_t trial) {
  const auto share = [](TriangleMesh mesh) { return std::make_shared<const TriangleMesh>(std::move(mesh)); };
  const std::shared_ptr<const TriangleMesh> meshes[] = {share(mesh_of(Primitive::cylinder(0.03, 0.06), 64)),
                                                        share(mesh_of(Primitive::box({0.08, 0.05, 0.02})))};
  Rng rng = Seed{trial}.child("heap").rng();
  RenderScene scene;
  for (std::size_t i = 0; i < kParts; ++i) {
    Pose X_WP = pose_from_xyz_rpy({rng.uniform(-0.1, 0.1), rng.uniform(-0.07, 0.07), rng.uniform(0, 0.08)}, {0, 0, 0});
    X_WP.linear() = rng.rotation().toRotationMatrix();
    scene.items.push_back({meshes[i % 2], X_WP, static_cast<std::int32_t>(i), {}});
  }
  scene.items.push_back({share(mesh_of(Primitive::box({2, 2, 0.01}))), Pose::Identity(), kIdTable, {}});
  return scene;
}

CaptureRequest request(std::uint64_t trial, std::uint64_t frame, int threads = 1) {
  CaptureRequest out;
  out.camera = test::cropped(PinholeCamera{}, 300, 200);
  out.X_WC_true = out.X_WC_believed =
      pose_from_xyz_rpy({0, 0, 0.55 + 0.01 * static_cast<double>(frame % 7)}, {M_PI, 0, 0});
  out.camera_seed = Seed{trial}.child("camera");
  out.frame_seed = Seed{trial}.child("frame", frame);
  out.threads = threads;
  return out;
}

TEST(SensorThreads, InsideAFrameChangeNothing) {
  const RenderScene scene = heap(1);
  const auto renderer = make_osmesa_renderer();
  for (const std::string& name : sensor_names()) {
    const auto sensor = make_sensor(name);
    const Capture one = capture_depth(*renderer, *sensor, scene, kParts, request(1, 2, 1));
    EXPECT_GT(test::fill(one.frame.depth), 0.5) << name;
    for (const int threads : {2, 3, 8}) {
      const Capture many = capture_depth(*renderer, *sensor, scene, kParts, request(1, 2, threads));
      EXPECT_TRUE(test::same_bits(one.frame.depth, many.frame.depth)) << name << " " << threads;
      for (std::size_t i = 0; i < kParts; ++i)
        EXPECT_EQ(one.visibility[i].silhouette_pixels, many.visibility[i].silhouette_pixels);
    }
  }
}

// The short form; `binpick bench sensors --thread-check 1000` is the long one.
TEST(SensorThreads, FourTrialsAtOnceMakeTheFramesOfOneByOne) {
  constexpr std::size_t kTrials = 4, kFrames = 40;
  std::vector<RenderScene> scenes;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) scenes.push_back(heap(10 + trial));
  const std::vector<std::string> names = sensor_names();
  const auto shoot = [&](DepthRenderer& renderer, std::size_t frame) {
    const auto sensor = make_sensor(names[frame / kTrials % names.size()]);
    const std::size_t trial = frame % kTrials;
    return capture_depth(renderer, *sensor, scenes[trial], kParts, request(10 + trial, frame)).frame.depth;
  };
  std::vector<Image<float>> together(kFrames);
  std::vector<std::thread> threads;
  for (std::size_t trial = 0; trial < kTrials; ++trial)
    threads.emplace_back([&, trial] {
      const auto renderer = make_renderer(trial % 2 ? "raycast" : "osmesa");
      for (std::size_t i = trial; i < kFrames; i += kTrials) together[i] = shoot(*renderer, i);
    });
  for (std::thread& thread : threads) thread.join();
  const auto osmesa = make_osmesa_renderer(), raycast = make_raycast_renderer();
  for (std::size_t i = 0; i < kFrames; ++i)
    EXPECT_TRUE(test::same_bits(together[i], shoot(i % kTrials % 2 ? *raycast : *osmesa, i))) << "frame " << i;
}

}  // namespace
}  // namespace binpick

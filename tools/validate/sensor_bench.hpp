// Walls and steps in front of a depth camera, rendered, and the sensors that look at them. What the checks V-A1..V-A8
// and the curves beside the published ones share.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/depth_quality.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/sensor_model.hpp"
#include "tools/validate/verdict.hpp"

namespace binpick {

/// A sensor of the registry with the keys of `yaml` set.
std::unique_ptr<SensorModel> configured_sensor(const std::string& type, const std::string& yaml);
/// `disparity` with every term off but those that `more` turns on.
std::unique_ptr<SensorModel> bare_disparity(const std::string& preset, const std::string& more);
/// The set-up of V-A1, V-A2 and V-A6: only the noise field, steps of 1/32 px and a unit of 0.1 mm are on.
std::unique_ptr<SensorModel> noise_only_disparity(const std::string& preset);

/// What a camera looks at: the scene in its own frame C, and that scene rendered.
struct BenchView {
  PinholeCamera camera;
  RenderScene scene;  ///< W = C
  ExactFrame exact;
  ImageRegion centre;       ///< 20 % of the whole image's sides, in the middle
  std::uint64_t range = 0;  ///< of its nearest surface, in 0.1 mm: every range has noise of its own
};

class SensorBench {
 public:
  static constexpr int kFullSeeds = 20;

  /// Seeds first .. first + count - 1. The quick form sees only the middle 40 % of each image's sides, at the same f.
  SensorBench(std::uint64_t first_seed, int seeds, bool quick, int threads);

  int seeds() const { return seeds_; }
  bool quick() const { return quick_; }
  std::vector<Verdict>& verdicts() { return verdicts_; }

  /// A wall through (0, 0, z) whose normal leans by `tilt` about y; its near and far planes suit `sensor`.
  BenchView wall(const SensorModel& sensor, double z, double tilt = 0, bool whole_image = false);
  /// A plate 120 mm wide at z_plate, its middle `shift` to the right of the axis, before a wall at z_wall.
  BenchView step(const SensorModel& sensor, double z_plate, double z_wall, double shift, bool whole_image = false);
  static constexpr double kPlateWidth = 0.12;  ///< m

  /// One frame: camera `camera`, frame `frame` of seed number k.
  Image<float> shoot(const SensorModel& sensor, const BenchView& view, int k, int frame = 0);
  /// `measure` of the frame of every seed, by index, on the bench's threads. Only for sensors that need no other view.
  std::vector<double> each_seed(const SensorModel& sensor, const BenchView& view,
                                const std::function<double(const Image<float>&)>& measure) const;
  /// `frames` frames of one camera.
  std::vector<Image<float>> film(const SensorModel& sensor, const BenchView& view, int k, int frames) const;

  /// A relative tolerance of an RMS over the centre region of each seed's image, widened when there are few seeds.
  double rms_tolerance(double tolerance, const BenchView& view, double correlation_length) const;

 private:
  BenchView look(const SensorModel& sensor, RenderScene scene, double range, bool whole_image);
  Seed seed(const BenchView& view, std::size_t k) const { return Seed{first_seed_ + k}.child("range", view.range); }

  std::uint64_t first_seed_;
  int seeds_;
  bool quick_;
  int threads_;
  std::unique_ptr<DepthRenderer> renderer_;
  std::vector<Verdict> verdicts_;
};

double mean_of(const std::vector<double>& values);

/// Missing pixels a row beside the left outline of a plate at z_plate: from 20 px beyond the shadow that is expected to
/// 5 px on the plate. For noisy frames; speckle holes count.
double missing_left_of_plate(const BenchView& view, const Image<float>& depth, double z_plate, double expected);

// The checks, each appending its lines to bench.verdicts().
void check_wall_noise(SensorBench& bench);         ///< V-A1, V-A2
void check_kinect_noise(SensorBench& bench);       ///< V-A3
void check_shadow(SensorBench& bench);             ///< V-A4
void check_depth_steps(SensorBench& bench);        ///< V-A5
void check_noise_correlation(SensorBench& bench);  ///< V-A6
void check_matching(SensorBench& bench);           ///< V-A7
void check_bias(SensorBench& bench);               ///< V-A8

}  // namespace binpick

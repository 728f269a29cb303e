#include "tools/validate/sensor_bench.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"
#include "core/primitive.hpp"
#include "core/yaml.hpp"

namespace binpick {
namespace {

constexpr double kCentreShare = 0.2;  // region of interest of V-A1
constexpr double kQuickShare = 0.4;   // of the image that the quick form sees
constexpr double kSlab = 0.005;       // m, thickness of walls and plates

// A slab whose visible face passes through (x, 0, z), leaning by `tilt` about y.
RenderItem slab(double width, double x, double z, double tilt, std::int32_t id) {
  Pose X_CS = Pose::Identity();
  X_CS.translation() = Eigen::Vector3d(x, 0, z);
  X_CS.linear() = Eigen::AngleAxisd(-tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();
  X_CS.translation() += X_CS.linear() * Eigen::Vector3d(0, 0, 0.5 * kSlab);
  const TriangleMesh mesh = mesh_of(Primitive::box({width, 4, kSlab}));
  return {std::make_shared<const TriangleMesh>(mesh), X_CS, id, {}};
}

PinholeCamera middle_of(PinholeCamera camera, double share) {
  const ImageRegion region = centre_region(camera, share);
  camera.width = region.u1 - region.u0;
  camera.height = region.v1 - region.v0;
  camera.cx -= region.u0;
  camera.cy -= region.v0;
  return camera;
}

}  // namespace

std::unique_ptr<SensorModel> configured_sensor(const std::string& type, const std::string& yaml) {
  auto sensor = make_sensor(type);
  if (!yaml.empty()) read_yaml_text(yaml, "validate", "", [&](ConfigVisitor& v) { sensor->visit(v); });
  sensor->validate();
  return sensor;
}

std::unique_ptr<SensorModel> bare_disparity(const std::string& preset, const std::string& more) {
  auto sensor = configured_sensor("disparity", "preset: " + preset +
                                                   "\nsubpixel_noise: 0\nincidence_gain: 0\nbias_sigma: 0\nripple: 0\n"
                                                   "lateral_jitter: 0\nfattening: 0\nmixed_share: 0\nspeckle: 0\n"
                                                   "occlusion: false\ngrazing_angle: 3\ngrazing_width: 0.001\n"
                                                   "return_low: 0\nmedian: false\nz_max: 3\n");
  read_yaml_text(more, "validate", "", [&](ConfigVisitor& v) { sensor->visit(v); });
  sensor->validate();
  return sensor;
}

std::unique_ptr<SensorModel> noise_only_disparity(const std::string& preset) {
  return bare_disparity(preset, "subpixel_noise: 0.08\ndepth_unit: 0.1 mm\n");
}

SensorBench::SensorBench(std::uint64_t first_seed, int seeds, bool quick, int threads)
    : first_seed_(first_seed), seeds_(seeds), quick_(quick), threads_(threads), renderer_(make_osmesa_renderer()) {}

BenchView SensorBench::look(const SensorModel& sensor, RenderScene scene, double range, bool whole_image) {
  BenchView view;
  const PinholeCamera whole = sensor.default_camera();
  const ImageRegion region = centre_region(whole, kCentreShare);
  view.camera = quick_ && !whole_image ? middle_of(whole, kQuickShare) : whole;
  view.centre = centre_region(view.camera, region.u1 - region.u0, region.v1 - region.v0);
  view.range = static_cast<std::uint64_t>(std::llround(range * 1e4));
  view.scene = std::move(scene);
  const double near = std::max(0.1 * sensor.z_min(), 0.02), far = 1.2 * sensor.z_max();
  view.exact = renderer_->render(view.scene, view.camera, Pose::Identity(), near, far);
  return view;
}

BenchView SensorBench::wall(const SensorModel& sensor, double z, double tilt, bool whole_image) {
  return look(sensor, {{slab(16, 0, z, tilt, 0)}}, z, whole_image);
}

BenchView SensorBench::step(const SensorModel& sensor, double z_plate, double z_wall, double shift, bool whole_image) {
  return look(sensor, {{slab(16, 0, z_wall, 0, 0), slab(kPlateWidth, shift, z_plate, 0, 1)}}, z_plate, whole_image);
}

Image<float> SensorBench::shoot(const SensorModel& sensor, const BenchView& view, int k, int frame) {
  const auto from_device = [&](const PinholeCamera& device, const Pose& X_CD, double near, double far) {
    return renderer_->render(view.scene, device, X_CD, near, far);
  };
  const Seed own = seed(view, static_cast<std::size_t>(k));
  return sensor.capture(SensorView{view.exact, view.camera, from_device, threads_}, own.child("camera"),
                        own.child("frame", static_cast<std::uint64_t>(frame)));
}

std::vector<double> SensorBench::each_seed(const SensorModel& sensor, const BenchView& view,
                                           const std::function<double(const Image<float>&)>& measure) const {
  std::vector<double> values(static_cast<std::size_t>(seeds_));
  parallel_for(values.size(), threads_, [&](std::size_t k) {
    const Seed own = seed(view, k);
    values[k] = measure(sensor.capture(view.exact, view.camera, own.child("camera"), own.child("frame")));
  });
  return values;
}

std::vector<Image<float>> SensorBench::film(const SensorModel& sensor, const BenchView& view, int k, int frames) const {
  std::vector<Image<float>> images(static_cast<std::size_t>(frames));
  const Seed own = seed(view, static_cast<std::size_t>(k));
  parallel_for(images.size(), threads_, [&](std::size_t i) {
    images[i] = sensor.capture(view.exact, view.camera, own.child("camera"), own.child("frame", i));
  });
  return images;
}

double SensorBench::rms_tolerance(double tolerance, const BenchView& view, double correlation_length) const {
  const int pixels = view.centre.pixels();
  return widened(tolerance, rms_standard_error(pixels, correlation_length, seeds_),
                 rms_standard_error(pixels, correlation_length, kFullSeeds));
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double missing_left_of_plate(const BenchView& view, const Image<float>& depth, double z_plate, double expected) {
  const double outline = view.camera.cx - 0.5 * SensorBench::kPlateWidth / z_plate * view.camera.fx;
  const int edge = static_cast<int>(std::lround(outline));
  const ImageRegion strip{edge - 20 - static_cast<int>(std::ceil(expected)), view.centre.v0, edge + 5, view.centre.v1};
  return (1 - fill_rate(depth, strip)) * (strip.u1 - strip.u0);
}

}  // namespace binpick

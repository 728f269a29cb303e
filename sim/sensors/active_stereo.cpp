// Sensor `active_stereo`: a stereo depth camera with a dot projector (RealSense D4xx), played through. Two infrared
// images of the scene are made and matched; depth fails where the images give the matcher nothing. In this order
// (physical_models A3.4; each step is one file of sim/optics):
//   1. the scene is drawn exactly from the left imager (frame C), the right imager (+x, baseline) and the projector
//   2. every pixel is shaded on the CPU: dots at the place where its point lies in the projector's picture, unless the
//      projector's own depth map says shadow; Lambert plus one lobe (core/material.hpp); 1/r^2; ambient light
//   3. lens blur; exposure (metered so that the left image has a given mean); speckle Gamma(k, 1/k), part of it fixed
//      with the camera seed; thermal noise; 8 bits, so that highlights saturate
//   4. OpenCV's semi-global matcher in three paths, its uniqueness, left-right, median and speckle tests; windows
//      without contrast, or with too many saturated pixels, are dropped
//   5. least-squares subpixel fit; d in steps of 1/32 px; z = f B / d in whole depth units within z_min .. z_max
// The dots are drawn once for each camera seed. f is the scene camera's fx, so f B follows the resolution; dots keep
// their angle. Both imagers have the same intrinsics; what lies outside the right image is lost.
//
// Presets: `d435_848` (default), `d435_1280`, `d415_1280`; baseline, f, z range, projector and stated s are rows of
// camera_table.cpp. d435_1280 has the keys of d435_848 but those and the dots, which keep their size in pixels.
//
// | key                | d435_848 | d415_1280 | unit | meaning and source
// | ------------------ | -------- | --------- | ---- | ------------------------------------------------------
// | baseline           | 50.1 mm  | 55 mm     | m    | between the imagers (A2)
// | projector_baseline | 29 mm    | 29 mm     | m    | projector at +x of the left imager (A3.4; assumed for the D415)
// | projector_fov      | 102 deg  | 90 deg    | rad  | horizontal; 16:9 (A3.4)
// | dot_pitch          | 10 mrad  | 4.7 mrad  | rad  | one cell of the pattern, 4.3 / f (chosen: windows are unique)
// | dot_radius         | 2.4 mrad | 1.1 mrad  | rad  | standard deviation of a dot, 1.03 / f (chosen: no aliasing)
// | dot_density        | 0.7      | same      |      | probability that a cell holds a dot (chosen)
// | background         | 0.1      | same      |      | light between the dots, 1 = the brightest dots (untuned)
// | ambient            | 0.3      | same      |      | irradiance; the brightest dots have 1 at 1 m (untuned)
// | mean_grey          | 60       | same      | grey | held by the automatic exposure (untuned)
// | exposure           | 0        | same      |      | fixed gain, grey levels per radiance; 0: automatic
// | blur               | 0.18     | same      |      | weight of each neighbour: a lens of 0.6 px (chosen)
// | speckle_shape      | 398.12   | same      |      | k of the Gamma speckle, 5 % of the light; 0: none (A1)
// | fixed_share        | 0.5      | same      |      | of the speckle's variance, the same in every frame (A3.3)
// | thermal_noise      | 0.83     | same      | grey | standard deviation (A1)
// | block              | 7        | same      | px   | side of the matching window, 3 .. 7, odd (A3.4)
// | uniqueness         | 10       | same      | %    | by which the best cost must win (A3.4 has 15 for a census cost)
// | speckle_size       | 60       | same      | px   | smaller islands of matches are removed (untuned)
// | contrast           | 3        | same      | grey | least standard deviation in the window (untuned)
// | saturated_share    | 0.5      | same      |      | of a window at 255: with more nothing is matched (untuned)
// | disparity_step     | 1/32     | same      | px   | 0 for none (A1)
// | stated_noise       | 0.08     | same      | px   | what the data sheet's noise amounts to (A2); not used in drawing
// | stated_fattening   | 1        | same      | px   | growth of the foreground that is stated; not used in drawing
// | depth_unit         | 0.1 mm   | same      | m    | 0 for none (A3.3)
// | z_min              | 0.171 m  | 0.402 m   | m    | f B / 126 (A1, A2): bounds the disparities searched
// | z_max              | 2 m      | same      | m    | range of use (A3.3)
//
// Repeatable: the matcher works in integers, with limits low enough that no 16-bit sum saturates, and cuts the image
// into a fixed number of strips. Its result was found the same for 1, 2 and 4 OpenCV threads and with OpenCV's
// AVX-512, AVX2, FMA and SSE 4 paths switched off (OPENCV_CPU_DISABLE). The rest is our own code in a fixed order.
//
// What it cannot do: real D4xx chips match census-like costs of which nothing is published, so agreement holds for
// figures (subpixel noise, fill, shadow), not for single pixels. The dots are not Intel's pattern. One lobe stands for
// all metal: no brushed grain, no mirror images of the pattern or of the surroundings, no light from surface to
// surface. Pixels are shaded at their centre; only the blur mixes them. Speckle is white from pixel to pixel and does
// not follow the surface when the camera moves. There is no bias of calibration and no warm-up drift (`disparity` has a
// bias). How much light metal returns is a placeholder (A3.5): sweep the material, do not read fill on metal as a
// RealSense's.

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "sim/noise/depth_grid.hpp"
#include "sim/optics/dot_pattern.hpp"
#include "sim/optics/infrared_imager.hpp"
#include "sim/optics/projector_light.hpp"
#include "sim/optics/stereo_matching.hpp"
#include "sim/sensors/camera_table.hpp"
#include "sim/sensors/models.hpp"

namespace binpick {
namespace {

constexpr double kDotPitch = 4.3, kDotRadius = 1.03;  // px of the preset's camera: nearly all 7 x 7 windows are unique
constexpr double kMaxGain = 1e5;                      // grey levels per unit of radiance: a black scene stays dark

struct ActiveStereoParameters {
  double baseline = 0;
  double projector_baseline = 0.029;
  double projector_fov = 0;
  DotPatternConfig pattern;
  double background = 0.1;
  double ambient = 0.3;
  double mean_grey = 60;
  double exposure = 0;
  double blur = 0.18;
  InfraredNoise noise;
  StereoMatching matching;
  double disparity_step = 1.0 / 32;
  double stated_noise = 0;
  double stated_fattening = 1;
  DepthGrid grid{1e-4, 0, 0};
  PinholeCamera camera;  // of the preset
};

const std::vector<std::string> kPresets = {"d435_848", "d435_1280", "d415_1280"};

ActiveStereoParameters preset_values(const std::string& preset) {
  const DepthCamera& row = depth_camera(preset);
  ActiveStereoParameters p;
  p.baseline = row.baseline;
  if (row.projector_baseline > 0) p.projector_baseline = row.projector_baseline;
  p.projector_fov = row.projector_field;
  p.stated_noise = row.subpixel_noise;
  p.grid.z_min = row.z_min;
  p.grid.z_max = row.z_max;
  p.camera = row.camera;
  p.pattern.pitch = kDotPitch / row.camera.fx;
  p.pattern.radius = kDotRadius / row.camera.fx;
  return p;
}

class ActiveStereoSensor : public SensorModel {
 public:
  void visit(ConfigVisitor& v) override;
  void validate() const override;
  PinholeCamera default_camera() const override { return p_.camera; }
  double z_min() const override { return p_.grid.z_min; }
  double z_max() const override { return p_.grid.z_max; }
  std::vector<std::string> presets() const override { return kPresets; }
  StatedNoise stated_noise(const PinholeCamera& camera) const override {
    const double fB = camera.fx * p_.baseline;
    return {0, 0, p_.stated_noise / fB, p_.stated_fattening, fB};
  }
  Image<float> capture(const SensorView& view, Seed camera_seed, Seed frame_seed) const override;

 private:
  Image<float> radiance(const ImagerView& imager, const ProjectorLight& light, const DotPattern& pattern,
                        const PinholeCamera& device, int threads) const;
  Image<float> to_depth(const Image<float>& disparity, double fB) const;

  std::string preset_ = kPresets.front();
  ActiveStereoParameters p_ = preset_values(kPresets.front());
};

void ActiveStereoSensor::visit(ConfigVisitor& v) {
  v.choice("preset", preset_, kPresets, "values to start from; the keys below override them");
  if (v.reading() && v.has("preset")) p_ = preset_values(preset_);
  v.field("baseline", p_.baseline, Unit::kLength, "distance between the imagers");
  v.field("projector_baseline", p_.projector_baseline, Unit::kLength, "projector at +x of the left imager");
  v.field("projector_fov", p_.projector_fov, Unit::kAngle, "horizontal field of view of the projector");
  v.field("dot_pitch", p_.pattern.pitch, Unit::kAngle, "side of a cell of the dot pattern");
  v.field("dot_radius", p_.pattern.radius, Unit::kAngle, "standard deviation of a dot");
  v.field("dot_density", p_.pattern.density, Unit::kNone, "probability that a cell holds a dot");
  v.field("background", p_.background, Unit::kNone, "light between the dots, as a share of the brightest dots");
  v.field("ambient", p_.ambient, Unit::kNone, "ambient irradiance; the brightest dots have 1 at a distance of 1 m");
  v.field("mean_grey", p_.mean_grey, Unit::kNone, "mean grey level that the automatic exposure holds");
  v.field("exposure", p_.exposure, Unit::kNone, "fixed gain, grey levels per unit of radiance; 0: automatic");
  v.field("blur", p_.blur, Unit::kNone, "weight of each neighbour in the lens blur");
  v.field("speckle_shape", p_.noise.speckle_shape, Unit::kNone, "shape k of the Gamma speckle; 0: none");
  v.field("fixed_share", p_.noise.fixed_share, Unit::kNone, "share of the speckle's variance that stays");
  v.field("thermal_noise", p_.noise.thermal, Unit::kNone, "standard deviation, grey levels");
  v.field("block", p_.matching.block, "side of the matching window, px, odd");
  v.field("uniqueness", p_.matching.uniqueness, "per cent by which the best match must win");
  v.field("speckle_size", p_.matching.speckle_size, "smaller islands of matches are removed, px");
  v.field("contrast", p_.matching.contrast, Unit::kNone, "least standard deviation in the window, grey levels");
  v.field("saturated_share", p_.matching.saturated_share, Unit::kNone, "of a window; with more there is no match");
  v.field("disparity_step", p_.disparity_step, Unit::kNone, "step of the disparity, px; 0 for none");
  v.field("stated_noise", p_.stated_noise, Unit::kNone, "subpixel noise that the data sheet states, px");
  v.field("stated_fattening", p_.stated_fattening, Unit::kNone, "growth of the foreground that is stated, px");
  v.field("depth_unit", p_.grid.unit, Unit::kLength, "step of the delivered depth; 0 for none");
  v.field("z_min", p_.grid.z_min, Unit::kLength, "nearer points give no return");
  v.field("z_max", p_.grid.z_max, Unit::kLength, "farther points give no return");
}

void ActiveStereoSensor::validate() const {
  const auto check = [](const char* key, double value, double low, double high) {
    check_between("active_stereo", key, value, low, high);
  };
  check_depth_range("active_stereo", p_.grid.z_min, p_.grid.z_max);
  check("baseline", p_.baseline, 0.005, 1);
  check("projector_baseline", p_.projector_baseline, -1, 1);
  check("projector_fov", p_.projector_fov, 0.1, 2.6);
  check("dot_radius", p_.pattern.radius, 2e-4, 0.1);
  check("dot_pitch", p_.pattern.pitch, p_.pattern.radius, 0.5);
  check("dot_density", p_.pattern.density, 0, 1);
  check("background", p_.background, 0, 1);
  check("ambient", p_.ambient, 0, 1e6);
  check("mean_grey", p_.mean_grey, 1, 250);
  check("exposure", p_.exposure, 0, kMaxGain);
  check("blur", p_.blur, 0, 0.33);
  if (p_.noise.speckle_shape != 0) check("speckle_shape", p_.noise.speckle_shape, 10, 1e9);
  check("fixed_share", p_.noise.fixed_share, 0, 1);
  check("thermal_noise", p_.noise.thermal, 0, 100);
  if (p_.matching.block % 2 == 0) throw SpecError("sensor active_stereo: block must be odd");
  check("block", p_.matching.block, 3, 7);
  check("uniqueness", p_.matching.uniqueness, 0, 100);
  check("speckle_size", p_.matching.speckle_size, 0, 1e6);
  check("contrast", p_.matching.contrast, 0, 100);
  check("saturated_share", p_.matching.saturated_share, 0, 1);
  check("disparity_step", p_.disparity_step, 0, 1);
  check("stated_noise", p_.stated_noise, 0, 2);
  check("stated_fattening", p_.stated_fattening, 0, 10);
  check("depth_unit", p_.grid.unit, 0, 0.01);
}

Image<float> ActiveStereoSensor::radiance(const ImagerView& imager, const ProjectorLight& light,
                                          const DotPattern& pattern, const PinholeCamera& device, int threads) const {
  Image<float> image(imager.camera.width, imager.camera.height);
  parallel_for(static_cast<std::size_t>(image.height()), threads, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < image.width(); ++u) {
      const PixelLight seen = light.at(imager, u, v);
      double sum = seen.ambient * p_.ambient;
      if (seen.beam > 0) {
        const Eigen::Vector3d ray_D = device.ray(seen.pixel_D.x(), seen.pixel_D.y());
        sum += seen.beam * (p_.background + pattern.at(ray_D.x(), ray_D.y()));
      }
      image(u, v) = static_cast<float>(sum);
    }
  });
  blur(image, p_.blur);
  return image;
}

Image<float> ActiveStereoSensor::to_depth(const Image<float>& disparity, double fB) const {
  Image<float> depth(disparity.width(), disparity.height());
  for (std::size_t i = 0; i < depth.size(); ++i)
    depth[i] = depth_of_disparity(disparity[i], p_.disparity_step, fB, p_.grid);
  return depth;
}

Image<float> ActiveStereoSensor::capture(const SensorView& view, Seed camera_seed, Seed frame_seed) const {
  BP_CHECK(view.from_device);
  const double near = 0.1 * p_.grid.z_min, far = 1.2 * p_.grid.z_max, fB = view.camera.fx * p_.baseline;
  Pose X_CR = Pose::Identity(), X_CD = Pose::Identity();
  X_CR.translation().x() = p_.baseline;
  X_CD.translation().x() = p_.projector_baseline;
  DotPatternConfig dots = p_.pattern;
  dots.half_x = std::tan(0.5 * p_.projector_fov);
  dots.half_y = dots.half_x * 9 / 16;
  const PinholeCamera device =
      covering_device(view.camera, X_CD, view.camera.fx, {p_.grid.z_min, far}, {dots.half_x, dots.half_y});
  const ExactFrame right = view.from_device(view.camera, X_CR, near, far);
  const ProjectorLight light(view.from_device(device, X_CD, near, far), device, X_CD);
  const DotPattern pattern(dots, camera_seed.child("dots"));
  const Image<float> light_left =
      radiance({view.exact, view.camera, Pose::Identity()}, light, pattern, device, view.threads);
  const Image<float> light_right = radiance({right, view.camera, X_CR}, light, pattern, device, view.threads);
  const double gain = p_.exposure > 0 ? p_.exposure : exposure_for_mean(light_left, p_.mean_grey, kMaxGain);
  const auto shot = [&](const Image<float>& image, const char* name) {
    return expose(image, gain, p_.noise, camera_seed.child(name).rng(), frame_seed.child(name).rng(), view.threads);
  };
  StereoMatching matching = p_.matching;
  const int widest = std::min(static_cast<int>(std::ceil(fB / p_.grid.z_min)), view.camera.width);
  matching.disparities = (widest + 2 + 15) / 16 * 16;
  return to_depth(match_pair(shot(light_left, "left"), shot(light_right, "right"), matching, view.threads), fB);
}

}  // namespace

std::unique_ptr<SensorModel> make_active_stereo_sensor() { return std::make_unique<ActiveStereoSensor>(); }

}  // namespace binpick

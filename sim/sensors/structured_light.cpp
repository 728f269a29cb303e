// Sensor `structured_light`: one camera and one projector of stripes (Zivid, PhoXi), played through: every stripe image
// is shaded, shot and decoded. In this order (physical_models A3.5; each step is one file of sim/optics):
//   1. the scene is drawn exactly from the camera (frame C) and the projector (+x, turned in so that the axes meet at
//      the working distance); every pixel is shaded on the CPU: Lambert plus one lobe, 1/r^2, projector's shadow by its
//      own depth map, ambient light
//   2. cosines over the projector's columns, `steps` shifts of 1, ratio and ratio^2 periods; brightness 0 .. 1
//   3. optionally light by way of one other surface; lens blur
//   4. every shot: photon noise, read noise, speckle of the light, saturation, 8 .. 16 bits; a pixel that saturates is
//      taken from the next shorter exposure
//   5. wrapped phases, each unwrapped by the one before; pixels that saturate or hardly vary are lost
//   6. z where the pixel's ray meets the column's plane; lone pixels are lost; whole depth units within z_min .. z_max
// A wall's noise is sigma_z = z^2 sigma_px / (f B); sigma_px follows from the shots (tests work it out on paper).
// Exposures are fixed, and nothing stays with the unit: noise is new in every frame.
//
// Presets: `zivid_2` (default) and `phoxi_m`, each at half of its camera's resolution; f, B and z range are rows of
// camera_table.cpp. B, and sigma 0.055 mm at 0.7 m and 0.10 mm at 0.65 m, are recalled values ([R] in physical_models
// A2) that nobody checked against a data sheet. full_well (Zivid) and speckle (PhoXi) were set so that a wall of albedo
// 0.6 shows that sigma; they are not measurements.
//
// | key              | zivid_2 | phoxi_m | unit | meaning and source
// | ---------------- | ------- | ------- | ---- | ----------------------------------------------------------
// | baseline         | 110 mm  | 270 mm  | m    | projector at +x of the camera (A2 [R])
// | working_distance | 0.7 m   | 0.65 m  | m    | where the two axes meet (A2 [R])
// | projector_fov    | 46 deg  | 53 deg  | rad  | horizontal; covers the camera's view there (chosen)
// | steps            | 4       | same    |      | shifts of each frequency (chosen)
// | ratio            | 10      | same    |      | 1, 10 and 100 periods: 13 px each in the camera (chosen)
// | contrast         | 0.9     | same    |      | modulation of the projected cosines (untuned)
// | ambient          | 0.1     | same    |      | irradiance; white light of the projector has 1 at 1 m (untuned)
// | exposure         | 0.75    | same    |      | share of the well a white wall fills at working distance
// | exposures        | 3       | same    |      | each a quarter of the one before, while a pixel saturates
// | blur             | 0.1     | same    |      | weight of each neighbour: a lens of 0.45 px (untuned)
// | full_well        | 52000   | same    | e    | four binned pixels; set by the stated sigma of the Zivid
// | read_noise       | 10      | same    | e    | standard deviation (untuned)
// | bits             | 12      | same    |      | of the digitiser
// | speckle          | 0       | 0.031   |      | share; set by the stated sigma of the PhoXi
// | modulation       | 0.01    | same    |      | least amplitude of a cosine, share of the well (untuned)
// | outlier          | 5 mm    | same    | m    | a pixel needs three neighbours nearer than this; 0: no test
// | interreflection  | false   | same    |      | light by way of one other surface
// | stated_noise     | 0.017   | 0.0735  | px   | what the stated sigma amounts to (A2 [R]); not used in drawing
// | depth_unit       | 0.01 mm | same    | m    | 0 for none (chosen)
// | z_min            | 0.3 m   | 0.458 m | m    | A2
// | z_max            | 1.5 m   | same    | m    | A2
//
// What it cannot do: real devices choose exposures for the scene, filter and fill by rules that are not published.
// Stripes are ideal cosines: no defocus of the projector, no gamma, no sampling of its mirrors. Interreflection is a
// coarse gather (stripe_light.hpp) without shadows or lobes: mirror images of stripes, which real polished concave
// corners show, do not exist here. One lobe stands for all metal. Nothing moves between the shots, and no bias of
// calibration or temperature is drawn.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "sim/noise/depth_grid.hpp"
#include "sim/optics/infrared_imager.hpp"
#include "sim/optics/stripe_light.hpp"
#include "sim/optics/stripe_shots.hpp"
#include "sim/sensors/camera_table.hpp"
#include "sim/sensors/models.hpp"

namespace binpick {
namespace {

struct StructuredLightParameters {
  double baseline = 0;
  double working_distance = 0.7;
  double projector_fov = 0;
  PhaseShift stripes;
  double exposure = 0.75;
  double blur = 0.1;
  StripeShots shots;
  double outlier = 0.005;
  bool interreflection = false;
  double stated_noise = 0;
  DepthGrid grid{1e-5, 0, 0};
  PinholeCamera camera;  // of the preset
};

const std::vector<std::string> kPresets = {"zivid_2", "phoxi_m"};
constexpr double kDegree = std::numbers::pi / 180;

StructuredLightParameters preset_values(const std::string& preset) {
  const DepthCamera& row = depth_camera(preset);
  StructuredLightParameters p;
  p.baseline = row.baseline;
  p.grid.z_min = row.z_min;
  p.grid.z_max = row.z_max;
  p.camera = row.camera;
  p.projector_fov = 46 * kDegree;
  p.stated_noise = 0.017;
  if (preset == "phoxi_m") {
    p.working_distance = 0.65;
    p.projector_fov = 53 * kDegree;
    p.shots.speckle = 0.031;
    p.stated_noise = 0.0735;
  }
  return p;
}

class StructuredLightSensor : public SensorModel {
 public:
  void visit(ConfigVisitor& v) override;
  void validate() const override;
  std::vector<std::string> presets() const override { return kPresets; }
  PinholeCamera default_camera() const override { return p_.camera; }
  double z_min() const override { return p_.grid.z_min; }
  double z_max() const override { return p_.grid.z_max; }
  StatedNoise stated_noise(const PinholeCamera& camera) const override {
    return {0, 0, p_.stated_noise / (camera.fx * p_.baseline), 0};
  }
  Image<float> capture(const SensorView& view, Seed camera_seed, Seed frame_seed) const override;

 private:
  Pose projector_pose() const;
  StripeBasis light_of(const SensorView& view, const PhaseShift& stripes) const;
  Image<float> without_outliers(const Image<float>& depth) const;
  /// Electrons per unit of radiance: a white wall at the working distance fills `exposure` of the well.
  double longest_gain() const {
    return p_.exposure * p_.shots.full_well * std::numbers::pi * p_.working_distance * p_.working_distance;
  }

  std::string preset_ = kPresets.front();
  StructuredLightParameters p_ = preset_values(kPresets.front());
};

void StructuredLightSensor::visit(ConfigVisitor& v) {
  v.choice("preset", preset_, kPresets, "values to start from; the keys below override them");
  if (v.reading() && v.has("preset")) p_ = preset_values(preset_);
  v.field("baseline", p_.baseline, Unit::kLength, "projector at +x of the camera");
  v.field("working_distance", p_.working_distance, Unit::kLength, "where the two axes meet");
  v.field("projector_fov", p_.projector_fov, Unit::kAngle, "horizontal field of view of the projector");
  v.field("steps", p_.stripes.steps, "phase shifts of each frequency");
  v.field("ratio", p_.stripes.ratio, "of one frequency to the next: 1, ratio, ratio^2 periods");
  v.field("contrast", p_.shots.contrast, Unit::kNone, "modulation of the projected cosines");
  v.field("ambient", p_.shots.ambient, Unit::kNone, "ambient irradiance; white light of the projector has 1 at 1 m");
  v.field("exposure", p_.exposure, Unit::kNone, "share of the well that a white wall fills at the working distance");
  v.field("exposures", p_.shots.exposures,
          "tried one after the other, each a quarter of the one before, while pixels saturate");
  v.field("blur", p_.blur, Unit::kNone, "weight of each neighbour in the lens blur");
  v.field("full_well", p_.shots.full_well, Unit::kNone, "electrons at which a pixel saturates");
  v.field("read_noise", p_.shots.read_noise, Unit::kNone, "standard deviation, electrons");
  v.field("bits", p_.shots.bits, "of the camera's digitiser");
  v.field("speckle", p_.shots.speckle, Unit::kNone, "noise of the light itself, share, new in every shot");
  v.field("modulation", p_.shots.modulation, Unit::kNone, "least amplitude of the cosine, share of the well");
  v.field("outlier", p_.outlier, Unit::kLength, "a pixel needs three neighbours nearer than this in depth; 0: no test");
  v.field("interreflection", p_.interreflection, "light by way of one other surface");
  v.field("stated_noise", p_.stated_noise, Unit::kNone, "what the data sheet's noise amounts to, px");
  v.field("depth_unit", p_.grid.unit, Unit::kLength, "step of the delivered depth; 0 for none");
  v.field("z_min", p_.grid.z_min, Unit::kLength, "nearer points give no return");
  v.field("z_max", p_.grid.z_max, Unit::kLength, "farther points give no return");
}

void StructuredLightSensor::validate() const {
  const auto check = [](const char* key, double value, double low, double high) {
    check_between("structured_light", key, value, low, high);
  };
  check_depth_range("structured_light", p_.grid.z_min, p_.grid.z_max);
  check("baseline", p_.baseline, 0.005, 2);
  check("working_distance", p_.working_distance, 0.05, 20);
  check("projector_fov", p_.projector_fov, 0.1, 2);
  check("steps", p_.stripes.steps, 3, 32);
  check("ratio", p_.stripes.ratio, 2, 20);
  check("contrast", p_.shots.contrast, 0.05, 1);
  check("ambient", p_.shots.ambient, 0, 1e6);
  check("exposure", p_.exposure, 1e-4, 1e3);
  check("exposures", p_.shots.exposures, 1, 6);
  check("blur", p_.blur, 0, 0.33);
  check("full_well", p_.shots.full_well, 100, 1e7);
  check("read_noise", p_.shots.read_noise, 0, 1e4);
  check("bits", p_.shots.bits, 6, 16);
  check("speckle", p_.shots.speckle, 0, 1);
  check("modulation", p_.shots.modulation, 1e-4, 0.5);
  check("outlier", p_.outlier, 0, 1);
  check("stated_noise", p_.stated_noise, 0, 2);
  check("depth_unit", p_.grid.unit, 0, 0.01);
}

Pose StructuredLightSensor::projector_pose() const {
  const double toe_in = std::atan2(p_.baseline, p_.working_distance);
  Pose X_CD = Pose::Identity();
  X_CD.linear() = Eigen::AngleAxisd(-toe_in, Eigen::Vector3d::UnitY()).toRotationMatrix();
  X_CD.translation().x() = p_.baseline;
  return X_CD;
}

StripeBasis StructuredLightSensor::light_of(const SensorView& view, const PhaseShift& stripes) const {
  const double near = 0.1 * p_.grid.z_min, far = 1.2 * p_.grid.z_max;
  const Pose X_CD = projector_pose();
  const PinholeCamera device =
      covering_device(view.camera, X_CD, view.camera.fx, {p_.grid.z_min, far}, {stripes.half, stripes.half});
  const ProjectorLight light(view.from_device(device, X_CD, near, far), device, X_CD);
  const ImagerView imager{view.exact, view.camera, Pose::Identity()};
  StripeBasis basis = shade_stripes(imager, light, device, stripes, view.threads);
  if (p_.interreflection) add_interreflection(imager, view.threads, basis);
  blur(basis.ambient, p_.blur);
  parallel_for(basis.channels.size(), view.threads, [&](std::size_t c) { blur(basis.channels[c], p_.blur); });
  return basis;
}

Image<float> StructuredLightSensor::without_outliers(const Image<float>& depth) const {
  if (!(p_.outlier > 0)) return depth;
  Image<float> kept = depth;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u) {
      if (std::isnan(depth(u, v))) continue;
      int near = -1;  // itself
      for (int j = std::max(v - 1, 0); j <= std::min(v + 1, depth.height() - 1); ++j)
        for (int i = std::max(u - 1, 0); i <= std::min(u + 1, depth.width() - 1); ++i)
          near += std::abs(depth(i, j) - depth(u, v)) < p_.outlier;
      if (near < 3) kept(u, v) = std::nanf("");
    }
  return kept;
}

Image<float> StructuredLightSensor::capture(const SensorView& view, Seed, Seed frame_seed) const {
  BP_CHECK(view.from_device);
  PhaseShift stripes = p_.stripes;
  stripes.half = std::tan(0.5 * p_.projector_fov);
  const StripeBasis basis = light_of(view, stripes);
  const StripeDecoder decoder(basis, stripes, p_.shots, longest_gain());
  const Pose X_CD = projector_pose(), X_DC = X_CD.inverse();
  const Rng noise = frame_seed.child("shots").rng();
  Image<float> depth(view.camera.width, view.camera.height, std::nanf(""));
  parallel_for(static_cast<std::size_t>(depth.height()), view.threads, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < depth.width(); ++u) {
      const std::size_t pixel = row * static_cast<std::size_t>(depth.width()) + static_cast<std::size_t>(u);
      const double x = decoder.position(pixel, noise.at(pixel));
      if (std::isnan(x)) continue;
      // The column x is the plane m . (p_C - p_CD) = 0 with m = R_DC's rows 1 - x 3; it meets the pixel's ray at z.
      const Eigen::Vector3d m = (X_DC.linear().row(0) - x * X_DC.linear().row(2)).transpose();
      depth(u, v) = on_grid(m.dot(X_CD.translation()) / m.dot(view.camera.ray(u, v)), p_.grid);
    }
  });
  return without_outliers(depth);
}

}  // namespace

std::unique_ptr<SensorModel> make_structured_light_sensor() { return std::make_unique<StructuredLightSensor>(); }

}  // namespace binpick

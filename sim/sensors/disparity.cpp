// Sensor `disparity`: a stereo depth camera (RealSense D4xx), its noise made where the camera makes it, in the
// disparity d = f B / z. In this order (physical_models A3.3; each term is one file of sim/noise):
//   1. what the second imager (and, if asked, the projector) cannot see is lost: a shadow left of every foreground
//   2. each pixel samples its surface with lateral jitter
//   3. foreground grows over its outline
//   4. grazing surfaces, weak and saturated returns are lost
//   5. d += bias + ripple sin(2 pi d) + s (1 + k tan^2 t) g
//   6. median 3 x 3
//   7. mixed pixels at outlines (after the median: they come from resampling, not from matching)
//   8. speckle holes
//   9. d in steps of 1/32 px, z = f B / d in whole depth units, nothing outside z_min .. z_max
// g is a Gaussian field of variance 1 whose fixed share belongs to the camera and does not average out over frames; the
// bias is drawn once for each camera. f is the scene camera's fx, so f B follows the resolution.
//
// Presets, by camera and width: `d435_848` (default), `d435_1280`, `d415_1280`, `d405_848`, `d405_1280`, `d455_848` are
// calibrated units; f, B, z_min, z_max and s are rows of camera_table.cpp, everything else is the same. `.._out_of_box`
// (D435 and D415) has bias_sigma 0.3, ripple 0.1 and depth_unit 1 mm (at 0.6 m a bias of 0.3 px is 5 mm: only
// calibration can undo it).
//
// What it cannot do: it matches nothing, so that neither texture, nor repetition, nor a highlight that differs between
// the two views causes a wrong match; a surface that is lost is lost by angle and brightness alone.
//
// | key                | d435_848 | d415_1280 | unit | meaning and source
// | ------------------ | -------- | --------- | ---- | ------------------------------------------------------
// | baseline           | 50.1 mm  | 55 mm     | m    | between the imagers (A2)
// | subpixel_noise     | 0.08     | same      | px   | s, RMS disparity error of a frontal wall (A1)
// | correlation_length | 2.5      | same      | px   | standard deviation of the filter of g (A3.3)
// | fixed_share        | 0.5      | same      |      | share of g's variance that stays with the camera (A3.3)
// | incidence_gain     | 0.1      | same      |      | k; t is cut at 80 degrees (perception_noise 10.1)
// | bias_mean          | 0        | same      | px   | mean of the disparity bias
// | bias_sigma         | 0.03     | same      | px   | its spread from camera to camera (A3.3)
// | ripple             | 0.03     | same      | px   | subpixel ripple (A3.3)
// | lateral_jitter     | 0.5      | same      | px   | standard deviation in u and in v (A3.3)
// | fattening          | 1        | same      | px   | growth of the foreground (A3.3)
// | mixed_share        | 0.3      | same      |      | probability of a mixed pixel at an outline, untuned (A1)
// | speckle            | 0.005    | same      |      | probability of a hole (A3.3)
// | occlusion          | true     | same      |      | shadow of the second imager
// | projector_baseline | 0        | same      | m    | projector at +x of the camera; D435: 29 mm; 0: no shadow
// | grazing_angle      | 75 deg   | same      | rad  | half of such pixels are lost (A3.3, placeholder)
// | grazing_width      | 3 deg    | same      | rad  | of the logistic (A3.3, placeholder)
// | lobe               | 0        | same      | 1/m2 | mirror-like return added head on (placeholder, for sweeps)
// | lobe_exponent      | 60       | same      |      | the lobe falls as this power of cos t (placeholder)
// | return_low         | 0.02     | same      | 1/m2 | weaker returns are lost (placeholder)
// | return_high        | 1000     | same      | 1/m2 | stronger returns are lost (placeholder)
// | median             | true     | same      |      | 3 x 3 median of the disparity (A3.3)
// | disparity_step     | 1/32     | same      | px   | 0 for none (A1)
// | depth_unit         | 0.1 mm   | same      | m    | 0 for none (A3.3)
// | z_min              | 0.171 m  | 0.402 m   | m    | f B / 126 (A1, A2)
// | z_max              | 2 m      | same      | m    | range of use (A3.3); D405: 1 m

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/noise/correlated_field.hpp"
#include "sim/noise/depth_grid.hpp"
#include "sim/noise/dropout.hpp"
#include "sim/noise/median.hpp"
#include "sim/noise/mixed_pixels.hpp"
#include "sim/noise/rows.hpp"
#include "sim/noise/sampling.hpp"
#include "sim/noise/second_view.hpp"
#include "sim/sensors/camera_table.hpp"
#include "sim/sensors/models.hpp"

namespace binpick {
namespace {

constexpr double kLargestTan2 = 32.16;  // tan^2(80 deg): beyond, the incidence factor grows no more

// sin(2 pi x) to 1e-9, without libm: the nearest whole turn off, folded to a quarter, then the Taylor series.
double sine_of_turns(double x) {
  constexpr int kAway = 1 << 20;  // a cast rounds towards zero, hence from the positive side
  double turn = x - (static_cast<int>(x + kAway + 0.5) - kAway);
  if (turn > 0.25) turn = 0.5 - turn;
  if (turn < -0.25) turn = -0.5 - turn;
  const double t = 2 * std::numbers::pi * turn, q = t * t;
  const double tail = 1 - q * (1.0 / 110) * (1 - q * (1.0 / 156) * (1 - q * (1.0 / 210)));
  return t * (1 - q * (1.0 / 6) * (1 - q * (1.0 / 20) * (1 - q * (1.0 / 42) * (1 - q * (1.0 / 72) * tail))));
}

struct DisparityParameters {
  double baseline = 0;
  double subpixel_noise = 0;
  CorrelatedField field;
  double incidence_gain = 0.1;
  double bias_mean = 0, bias_sigma = 0.03;
  double ripple = 0.03;
  double lateral_jitter = 0.5;
  int fattening = 1;
  double mixed_share = 0.3;
  double speckle = 0.005;
  bool occlusion = true;
  double projector_baseline = 0;
  Dropout dropout;
  bool median = true;
  double disparity_step = 1.0 / 32;
  DepthGrid grid{1e-4, 0, 0};
  PinholeCamera camera;  // of the preset
};

const std::string kOutOfBox = "_out_of_box";
const std::vector<std::string> kPresets = {"d435_848",  "d435_848_out_of_box",  "d435_1280", "d435_1280_out_of_box",
                                           "d415_1280", "d415_1280_out_of_box", "d405_848",  "d405_1280",
                                           "d455_848"};

DisparityParameters preset_values(const std::string& preset) {
  const bool out_of_box = preset.ends_with(kOutOfBox);
  const DepthCamera& row = depth_camera(out_of_box ? preset.substr(0, preset.size() - kOutOfBox.size()) : preset);
  DisparityParameters p;
  p.baseline = row.baseline;
  p.subpixel_noise = row.subpixel_noise;
  p.grid.z_min = row.z_min;
  p.grid.z_max = row.z_max;
  p.camera = row.camera;
  if (out_of_box) {
    p.bias_sigma = 0.3;
    p.ripple = 0.1;
    p.grid.unit = 1e-3;
  }
  return p;
}

class DisparitySensor : public SensorModel {
 public:
  void visit(ConfigVisitor& v) override;
  void validate() const override;
  PinholeCamera default_camera() const override { return p_.camera; }
  double z_min() const override { return p_.grid.z_min; }
  double z_max() const override { return p_.grid.z_max; }
  std::vector<std::string> presets() const override { return kPresets; }
  StatedNoise stated_noise(const PinholeCamera& camera) const override {
    const double fB = camera.fx * p_.baseline;
    return {0, 0, p_.subpixel_noise / fB, static_cast<double>(p_.fattening), fB};
  }
  Image<float> capture(const SensorView& seen, Seed camera_seed, Seed frame_seed) const override;

 private:
  Image<std::uint8_t> hidden(const StereoView& view) const;
  void add_noise(const StereoView& view, Seed camera_seed, Seed frame_seed, DisparityImage& image) const;
  Image<float> to_depth(const StereoView& view, const Image<float>& disparity) const;

  std::string preset_ = kPresets.front();
  DisparityParameters p_ = preset_values(preset_);
};

void DisparitySensor::visit(ConfigVisitor& v) {
  v.choice("preset", preset_, kPresets, "values to start from; the keys below override them");
  if (v.reading() && v.has("preset")) p_ = preset_values(preset_);
  v.field("baseline", p_.baseline, Unit::kLength, "distance between the imagers");
  v.field("subpixel_noise", p_.subpixel_noise, Unit::kNone, "RMS disparity error of a frontal wall, px");
  v.field("correlation_length", p_.field.length, Unit::kNone, "standard deviation of the noise filter, px");
  v.field("fixed_share", p_.field.fixed_share, Unit::kNone, "share of the noise variance that stays with the camera");
  v.field("incidence_gain", p_.incidence_gain, Unit::kNone, "k in s (1 + k tan^2 t), t the angle of incidence");
  v.field("bias_mean", p_.bias_mean, Unit::kNone, "mean of the disparity bias, px");
  v.field("bias_sigma", p_.bias_sigma, Unit::kNone, "spread of the disparity bias from camera to camera, px");
  v.field("ripple", p_.ripple, Unit::kNone, "amplitude of the subpixel ripple, px");
  v.field("lateral_jitter", p_.lateral_jitter, Unit::kNone, "standard deviation of the sampled place, px");
  v.field("fattening", p_.fattening, "growth of the foreground, px");
  v.field("mixed_share", p_.mixed_share, Unit::kNone, "probability of a mixed pixel at an outline");
  v.field("speckle", p_.speckle, Unit::kNone, "probability of a hole at random");
  v.field("occlusion", p_.occlusion, "what the second imager does not see is lost");
  v.field("projector_baseline", p_.projector_baseline, Unit::kLength,
          "projector at +x of the camera; 0: casts no shadow");
  v.field("grazing_angle", p_.dropout.grazing_angle, Unit::kAngle,
          "angle of incidence at which half the pixels are lost");
  v.field("grazing_width", p_.dropout.grazing_width, Unit::kAngle, "width of the logistic around it");
  v.field("lobe", p_.dropout.lobe, Unit::kNone, "mirror-like return added head on, 1/m^2");
  v.field("lobe_exponent", p_.dropout.lobe_exponent, Unit::kNone, "the lobe falls as this power of cos t");
  v.field("return_low", p_.dropout.return_low, Unit::kNone, "weaker returns are lost, 1/m^2");
  v.field("return_high", p_.dropout.return_high, Unit::kNone, "stronger returns saturate and are lost, 1/m^2");
  v.field("median", p_.median, "3 x 3 median of the disparity");
  v.field("disparity_step", p_.disparity_step, Unit::kNone, "step of the disparity, px; 0 for none");
  v.field("depth_unit", p_.grid.unit, Unit::kLength, "step of the delivered depth; 0 for none");
  v.field("z_min", p_.grid.z_min, Unit::kLength, "nearer points give no return");
  v.field("z_max", p_.grid.z_max, Unit::kLength, "farther points give no return");
}

void DisparitySensor::validate() const {
  const auto check = [](const char* key, double value, double low, double high) {
    check_between("disparity", key, value, low, high);
  };
  check_depth_range("disparity", p_.grid.z_min, p_.grid.z_max);
  check("baseline", p_.baseline, 0.005, 1);
  check("subpixel_noise", p_.subpixel_noise, 0, 2);
  check("correlation_length", p_.field.length, 0, 20);
  check("fixed_share", p_.field.fixed_share, 0, 1);
  check("incidence_gain", p_.incidence_gain, 0, 10);
  check("bias_mean", p_.bias_mean, -2, 2);
  check("bias_sigma", p_.bias_sigma, 0, 2);
  check("ripple", p_.ripple, 0, 0.5);
  check("lateral_jitter", p_.lateral_jitter, 0, 5);
  check("fattening", p_.fattening, 0, 10);
  check("mixed_share", p_.mixed_share, 0, 1);
  check("speckle", p_.speckle, 0, 1);
  check("projector_baseline", p_.projector_baseline, 0, 1);
  check("grazing_angle", p_.dropout.grazing_angle, 0, std::numbers::pi);
  check("grazing_width", p_.dropout.grazing_width, 1e-4, 1);
  check("lobe", p_.dropout.lobe, 0, 1e6);
  check("lobe_exponent", p_.dropout.lobe_exponent, 1, 1e4);
  check("return_low", p_.dropout.return_low, 0, 1e6);
  check("return_high", p_.dropout.return_high, p_.dropout.return_low, 1e9);
  check("disparity_step", p_.disparity_step, 0, 1);
  check("depth_unit", p_.grid.unit, 0, 0.01);
}

Image<std::uint8_t> DisparitySensor::hidden(const StereoView& view) const {
  Image<std::uint8_t> mask(view.camera.width, view.camera.height, 0);
  if (p_.occlusion) mask = hidden_from_second_view(view, true);
  if (p_.projector_baseline > 0) {
    const StereoView projector(view.exact, view.camera, p_.projector_baseline, view.threads);
    const Image<std::uint8_t> dark = hidden_from_second_view(projector, false);
    for (std::size_t i = 0; i < mask.size(); ++i) mask[i] |= dark[i];
  }
  return mask;
}

void DisparitySensor::add_noise(const StereoView& view, Seed camera_seed, Seed frame_seed,
                                DisparityImage& image) const {
  const double bias = p_.bias_mean + p_.bias_sigma * camera_seed.child("bias").rng().normal();
  const Image<float> g =
      correlated_field(view.camera.width, view.camera.height, p_.field, camera_seed.child("noise").rng(),
                       frame_seed.child("noise").rng(), view.threads);
  for_rows(view.camera.height, view.threads, [&](int first, int end) {
    for (std::size_t i = view.index(0, first); i < view.index(0, end); ++i) {
      if (image.source[i] < 0) continue;
      const double cosine = view.cos_incidence(static_cast<std::size_t>(image.source[i]));
      const double cos2 = std::max(cosine * cosine, 1e-6);
      const double s = p_.subpixel_noise * (1 + p_.incidence_gain * std::min((1 - cos2) / cos2, kLargestTan2));
      const double d = image.disparity[i];
      image.disparity[i] = static_cast<float>(d + bias + p_.ripple * sine_of_turns(d) + s * g[i]);
    }
  });
}

Image<float> DisparitySensor::to_depth(const StereoView& view, const Image<float>& disparity) const {
  Image<float> depth(disparity.width(), disparity.height());
  for_rows(depth.height(), view.threads, [&](int first, int end) {
    for (std::size_t i = view.index(0, first); i < view.index(0, end); ++i)
      depth[i] = depth_of_disparity(disparity[i], p_.disparity_step, view.fB(), p_.grid);
  });
  return depth;
}

Image<float> DisparitySensor::capture(const SensorView& seen, Seed camera_seed, Seed frame_seed) const {
  const StereoView view(seen.exact, seen.camera, p_.baseline, seen.threads);
  DisparityImage image = jittered_samples(view, p_.lateral_jitter, hidden(view), frame_seed.child("jitter").rng());
  grow_foreground(view, p_.fattening, image);
  drop_returns(view, p_.dropout, frame_seed.child("dropout").rng(), image);
  add_noise(view, camera_seed, frame_seed, image);
  if (p_.median) image.disparity = median_3x3(image.disparity, view.threads);
  mix_outlines(view, p_.mixed_share, frame_seed.child("mixed").rng(), image);
  drop_speckles(p_.speckle, frame_seed.child("speckle").rng(), view.threads, image);
  return to_depth(view, image.disparity);
}

}  // namespace

std::unique_ptr<SensorModel> make_disparity_sensor() { return std::make_unique<DisparitySensor>(); }

}  // namespace binpick

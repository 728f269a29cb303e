// Sensor `gauss_z`: white Gaussian noise on depth. In this order:
//   1. each pixel samples its surface at (u, v) + N(0, lateral_jitter) px
//   2. dark pixels, and pixels at the rim of a deep step, are lost
//   3. z += sigma(z) N(0, 1), sigma = max(least, constant + linear z + quadratic z^2), and beyond 60 degrees of
//   incidence
//      t an additional grazing / sqrt(z) (t / (pi/2 - t))^2
//   4. z in whole depth units, nothing outside z_min .. z_max
//
// What it cannot do: white noise is too easy for ICP (the mean of n points is sqrt(n) times better), nothing stays with
// the camera, and there is neither shadow, fattening nor mixed pixels. Use it as a baseline only.
//
// Presets; intrinsics and range are rows of camera_table.cpp, keys not named are 0:
//   d435_848 (default)  quadratic = s / (f B), s 0.08 px; depth_unit 0.1 mm
//   kinect_v1           sigma = 0.0012 + 0.0019 (z - 0.4)^2 m multiplied out, grazing 0.0001 (Nguyen, Izadi, Lovell
//   2012);
//                       depth_unit 1 mm. Their lateral sigma (0.8 px and more) is absent.
//   azure_kinect        0.5 mm + 1 mm/m max(z - 0.5 m, 0), which is max(0.5 mm, 1 mm/m z); lateral_jitter 0.25 px,
//                       edge_range 0.8 m, darkest 15/255 (BlenderProc's law); depth_unit 1 mm
//   zivid_2             0.055 mm at 0.7 m, growing with z^2 as phase noise does (A3.5); depth_unit 0.01 mm [R]
//   phoxi_m             0.10 mm at 0.65 m, likewise [R]
//   sigma_0.5mm         constant 0.5 mm on the camera of d435_848: the easiest noise of all
//
// | key            | unit      | meaning
// | -------------- | --------- | ---------------------------------------------------------------------------------
// | constant       | m         | sigma at z = 0
// | linear         | m per m   |
// | quadratic      | m per m^2 | stereo and phase: s / (f B)
// | least          | m         | sigma is never smaller (the stated noise leaves this out)
// | grazing        | m^(3/2)   | beyond 60 degrees
// | lateral_jitter | px        | standard deviation of the sampled place, in u and in v
// | edge_range     | m         | lost where the depths of 3 x 3 pixels span more; 0: none are
// | darkest        |           | lost where albedo x cos t is smaller (a head light's grey value, white = 1)
// | depth_unit     | m         | step of the delivered depth, 0 for none
// | z_min, z_max   | m         | nearer and farther points give no return

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random_field.hpp"
#include "sim/noise/depth_grid.hpp"
#include "sim/noise/disparity_image.hpp"
#include "sim/noise/rows.hpp"
#include "sim/sensors/camera_table.hpp"
#include "sim/sensors/models.hpp"

namespace binpick {
namespace {

struct GaussZParameters {
  double constant = 0, linear = 0, quadratic = 0, least = 0;
  double grazing = 0;
  double lateral_jitter = 0;
  double edge_range = 0;
  double darkest = 0;
  DepthGrid grid{1e-4, 0, 0};
  PinholeCamera camera;
};

const std::vector<std::string> kPresets = {"d435_848", "kinect_v1", "azure_kinect",
                                           "zivid_2",  "phoxi_m",   "sigma_0.5mm"};

GaussZParameters preset_values(const std::string& preset) {
  const DepthCamera& row = depth_camera(preset == "sigma_0.5mm" ? "d435_848" : preset);
  GaussZParameters p;
  p.camera = row.camera;
  p.grid = {1e-4, row.z_min, row.z_max};
  if (preset == "d435_848") p.quadratic = row.subpixel_noise / row.fB();
  if (preset == "kinect_v1") {
    p.constant = 0.0012 + 0.0019 * 0.4 * 0.4;
    p.linear = -2 * 0.0019 * 0.4;
    p.quadratic = 0.0019;
    p.grazing = 1e-4;
    p.grid.unit = 1e-3;
  }
  if (preset == "azure_kinect") {
    p.linear = 1e-3;
    p.least = 0.5e-3;
    p.lateral_jitter = 0.25;
    p.edge_range = 0.8;
    p.darkest = 15.0 / 255;
    p.grid.unit = 1e-3;
  }
  if (preset == "zivid_2") p.quadratic = 0.055e-3 / (0.7 * 0.7);
  if (preset == "phoxi_m") p.quadratic = 0.10e-3 / (0.65 * 0.65);
  if (preset == "zivid_2" || preset == "phoxi_m") p.grid.unit = 1e-5;
  if (preset == "sigma_0.5mm") p.constant = 0.5e-3;
  return p;
}

// Farthest less nearest depth around a pixel; what is empty counts for nothing.
double depth_span_3x3(const Image<float>& depth, int u, int v) {
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  for (int y = std::max(v - 1, 0); y <= std::min(v + 1, depth.height() - 1); ++y)
    for (int x = std::max(u - 1, 0); x <= std::min(u + 1, depth.width() - 1); ++x) {
      nearest = std::min(nearest, std::isnan(depth(x, y)) ? nearest : depth(x, y));
      farthest = std::max(farthest, std::isnan(depth(x, y)) ? farthest : depth(x, y));
    }
  return farthest - nearest;
}

class GaussZSensor : public SensorModel {
 public:
  void visit(ConfigVisitor& v) override;
  void validate() const override;
  std::vector<std::string> presets() const override { return kPresets; }
  PinholeCamera default_camera() const override { return p_.camera; }
  double z_min() const override { return p_.grid.z_min; }
  double z_max() const override { return p_.grid.z_max; }
  StatedNoise stated_noise(const PinholeCamera&) const override { return {p_.constant, p_.linear, p_.quadratic, 0}; }
  Image<float> capture(const SensorView& view, Seed camera_seed, Seed frame_seed) const override;

 private:
  double frontal_sigma(double z) const { return std::max(p_.constant + z * (p_.linear + z * p_.quadratic), p_.least); }
  double grazing_sigma(double z, double cosine) const;
  double sampled_depth(const StereoView& view, int u, int v, Rng draw) const;

  std::string preset_ = kPresets.front();
  GaussZParameters p_ = preset_values(preset_);
};

void GaussZSensor::visit(ConfigVisitor& v) {
  v.choice("preset", preset_, kPresets, "values to start from; the keys below override them");
  if (v.reading() && v.has("preset")) p_ = preset_values(preset_);
  v.field("constant", p_.constant, Unit::kLength, "standard deviation at z = 0");
  v.field("linear", p_.linear, Unit::kNone, "m of standard deviation per m of depth");
  v.field("quadratic", p_.quadratic, Unit::kNone, "m of standard deviation per m^2; stereo: s / (f B)");
  v.field("least", p_.least, Unit::kLength, "the standard deviation is never smaller");
  v.field("grazing", p_.grazing, Unit::kNone, "growth beyond 60 degrees of incidence, m sqrt(m)");
  v.field("lateral_jitter", p_.lateral_jitter, Unit::kNone, "standard deviation of the sampled place, px");
  v.field("edge_range", p_.edge_range, Unit::kLength, "lost where depths of 3 x 3 pixels span more; 0: none are");
  v.field("darkest", p_.darkest, Unit::kNone, "lost where albedo times the cosine of incidence is smaller");
  v.field("depth_unit", p_.grid.unit, Unit::kLength, "step of the delivered depth, 0 for none");
  v.field("z_min", p_.grid.z_min, Unit::kLength, "nearer points give no return");
  v.field("z_max", p_.grid.z_max, Unit::kLength, "farther points give no return");
}

void GaussZSensor::validate() const {
  check_depth_range("gauss_z", p_.grid.z_min, p_.grid.z_max);
  check_between("gauss_z", "depth_unit", p_.grid.unit, 0, 0.01);
  check_between("gauss_z", "grazing", p_.grazing, 0, 0.01);
  check_between("gauss_z", "quadratic", p_.quadratic, 0, 0.1);
  check_between("gauss_z", "least", p_.least, 0, 0.5);
  check_between("gauss_z", "lateral_jitter", p_.lateral_jitter, 0, 5);
  check_between("gauss_z", "edge_range", p_.edge_range, 0, 20);
  check_between("gauss_z", "darkest", p_.darkest, 0, 1);
  // The curve is a parabola that opens upwards: its vertex is the smallest sigma.
  const double vertex = p_.quadratic > 0 ? -p_.linear / (2 * p_.quadratic) : 0;
  for (const double z : {p_.grid.z_min, p_.grid.z_max, std::clamp(vertex, p_.grid.z_min, p_.grid.z_max)})
    check_between("gauss_z", "sigma over the depth range", p_.constant + z * (p_.linear + z * p_.quadratic), 0, 0.5);
}

double GaussZSensor::grazing_sigma(double z, double cosine) const {
  const double right_angle = std::numbers::pi / 2;
  const double t = std::acos(cosine);
  if (t < std::numbers::pi / 3) return 0;
  const double ratio = t / std::max(right_angle - t, 0.02);
  return p_.grazing / std::sqrt(z) * ratio * ratio;
}

// Depth of the surface in the pixel that the displaced ray falls in, where that ray meets its plane; NaN: lost.
double GaussZSensor::sampled_depth(const StereoView& view, int u, int v, Rng draw) const {
  const double su = u + p_.lateral_jitter * draw.normal(), sv = v + p_.lateral_jitter * draw.normal();
  const std::size_t source = view.index(std::clamp(static_cast<int>(std::lround(su)), 0, view.camera.width - 1),
                                        std::clamp(static_cast<int>(std::lround(sv)), 0, view.camera.height - 1));
  const double d = view.disparity_at(source, su, sv);
  return d > 0 ? view.fB() / d : std::numeric_limits<double>::quiet_NaN();
}

Image<float> GaussZSensor::capture(const SensorView& seen, Seed, Seed frame_seed) const {
  const ExactFrame& exact = seen.exact;
  // Any baseline will do: the plane of a pixel is carried over to the displaced ray in 1 / z, where it is linear.
  const StereoView view(exact, seen.camera, 0.05, seen.threads);
  const Rng noise = frame_seed.child("gauss_z").rng(), jitter = frame_seed.child("jitter").rng();
  Image<float> depth(exact.depth.width(), exact.depth.height(), std::numeric_limits<float>::quiet_NaN());
  for_rows(depth.height(), seen.threads, [&](int first, int end) {
    std::vector<float> draws(static_cast<std::size_t>(depth.width()));
    for (int v = first; v < end; ++v) {
      fill_normals(noise, static_cast<std::uint64_t>(v), draws);
      for (int u = 0; u < depth.width(); ++u) {
        const std::size_t pixel = view.index(u, v);
        const double cosine = p_.darkest > 0 || p_.grazing > 0 ? view.cos_incidence(pixel) : 1;
        if (exact.materials[exact.ids[pixel]].albedo * cosine < p_.darkest) continue;
        if (p_.edge_range > 0 && depth_span_3x3(exact.depth, u, v) > p_.edge_range) continue;
        const double z = p_.lateral_jitter > 0 ? sampled_depth(view, u, v, jitter.at(pixel)) : exact.depth[pixel];
        double sigma = frontal_sigma(z);
        if (p_.grazing > 0) sigma += grazing_sigma(z, cosine);
        depth(u, v) = on_grid(z + sigma * draws[static_cast<std::size_t>(u)], p_.grid);
      }
    }
  });
  return depth;
}

}  // namespace

std::unique_ptr<SensorModel> make_gauss_z_sensor() { return std::make_unique<GaussZSensor>(); }

}  // namespace binpick

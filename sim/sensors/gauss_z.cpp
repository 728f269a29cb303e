// Sensor `gauss_z`: white Gaussian noise on depth. sigma(z) = constant + linear z + quadratic z^2, and beyond 60
// degrees of incidence t an additional grazing / sqrt(z) * (t / (pi/2 - t))^2. White noise is too easy for ICP (the
// mean of n points is sqrt(n) times better); use it as a baseline only.
//
// Sources: stereo constant = linear = 0, quadratic = s / (f B); Kinect v1: Nguyen, Izadi, Lovell 2012,
// sigma = 0.0012 + 0.0019 (z - 0.4)^2 m, multiplied out.
//
// | key        | d435_848 (default) | kinect_v1 | unit      | meaning
// | ---------- | ------------------ | --------- | --------- | ---------------------------------------
// | constant   | 0                  | 1.504 mm  | m         | sigma at z = 0
// | linear     | 0                  | -0.00152  | m per m   |
// | quadratic  | 0.08 / 21.55       | 0.0019    | m per m^2 |
// | grazing    | 0                  | 0.0001    | m^(3/2)   | beyond 60 degrees
// | depth_unit | 0.1 mm             | 1 mm      | m         | step of the delivered depth, 0 for none
// | z_min      | 0.171 m            | 0.4 m     | m         | nearer points give no return
// | z_max      | 2 m                | 4 m       | m         | farther points give no return

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/noise/depth_grid.hpp"
#include "sim/sensors/models.hpp"

namespace binpick {
namespace {

struct GaussZParameters {
  double constant = 0;
  double linear = 0;
  double quadratic = 0.08 / (430.1 * 0.0501);
  double grazing = 0;
  DepthGrid grid{1e-4, 0.171, 2.0};
  PinholeCamera camera;
};

GaussZParameters kinect_v1() {
  GaussZParameters p;
  p.constant = 0.0012 + 0.0019 * 0.4 * 0.4;
  p.linear = -2 * 0.0019 * 0.4;
  p.quadratic = 0.0019;
  p.grazing = 1e-4;
  p.grid = {1e-3, 0.4, 4.0};
  p.camera = {640, 480, 580, 580, 319.5, 239.5};
  return p;
}

class GaussZSensor : public SensorModel {
 public:
  void visit(ConfigVisitor& v) override {
    v.choice("preset", preset_, {"d435_848", "kinect_v1"}, "values to start from; the keys below override them");
    if (v.reading() && v.has("preset")) p_ = preset_ == "kinect_v1" ? kinect_v1() : GaussZParameters{};
    v.field("constant", p_.constant, Unit::kLength, "standard deviation at z = 0");
    v.field("linear", p_.linear, Unit::kNone, "m of standard deviation per m of depth");
    v.field("quadratic", p_.quadratic, Unit::kNone, "m of standard deviation per m^2; stereo: s / (f B)");
    v.field("grazing", p_.grazing, Unit::kNone, "growth beyond 60 degrees of incidence, m sqrt(m)");
    v.field("depth_unit", p_.grid.unit, Unit::kLength, "step of the delivered depth, 0 for none");
    v.field("z_min", p_.grid.z_min, Unit::kLength, "nearer points give no return");
    v.field("z_max", p_.grid.z_max, Unit::kLength, "farther points give no return");
  }

  void validate() const override {
    check_depth_range("gauss_z", p_.grid.z_min, p_.grid.z_max);
    check_between("gauss_z", "depth_unit", p_.grid.unit, 0, 0.01);
    check_between("gauss_z", "grazing", p_.grazing, 0, 0.01);
    check_between("gauss_z", "quadratic", p_.quadratic, 0, 0.1);
    // The curve is a parabola that opens upwards: its vertex is the smallest sigma.
    const double vertex = p_.quadratic > 0 ? -p_.linear / (2 * p_.quadratic) : 0;
    for (const double z : {p_.grid.z_min, p_.grid.z_max, std::clamp(vertex, p_.grid.z_min, p_.grid.z_max)})
      check_between("gauss_z", "sigma over the depth range", frontal_sigma(z), 0, 0.5);
  }

  PinholeCamera default_camera() const override { return p_.camera; }
  double z_min() const override { return p_.grid.z_min; }
  double z_max() const override { return p_.grid.z_max; }
  StatedNoise stated_noise() const override { return {p_.constant, p_.linear, p_.quadratic, 0}; }

  Image<float> capture(const SensorView& view, Seed, Seed frame_seed) const override {
    const ExactFrame& exact = view.exact;
    const PinholeCamera& camera = view.camera;
    const Rng noise = frame_seed.child("gauss_z").rng();
    Image<float> depth(exact.depth.width(), exact.depth.height());
    for (int v = 0; v < depth.height(); ++v)
      for (int u = 0; u < depth.width(); ++u) {
        const double z = exact.depth(u, v);
        const auto pixel = static_cast<std::uint64_t>(v) * static_cast<std::uint64_t>(depth.width()) + u;
        double sigma = frontal_sigma(z);
        if (p_.grazing > 0) sigma += grazing_sigma(z, exact.normals_C(u, v).cast<double>(), camera.ray(u, v));
        depth(u, v) = on_grid(z + sigma * noise.at(pixel).normal(), p_.grid);
      }
    return depth;
  }

 private:
  double frontal_sigma(double z) const { return p_.constant + z * (p_.linear + z * p_.quadratic); }
  double grazing_sigma(double z, const Eigen::Vector3d& n_C, const Eigen::Vector3d& ray_C) const {
    const double right_angle = std::numbers::pi / 2;
    const double t = std::acos(std::clamp(-n_C.dot(ray_C.normalized()), 0.0, 1.0));
    if (t < std::numbers::pi / 3) return 0;
    const double ratio = t / std::max(right_angle - t, 0.02);
    return p_.grazing / std::sqrt(z) * ratio * ratio;
  }

  std::string preset_ = "d435_848";
  GaussZParameters p_;
};

}  // namespace

std::unique_ptr<SensorModel> make_gauss_z_sensor() { return std::make_unique<GaussZSensor>(); }

}  // namespace binpick

// Sensor `ideal`: the exact depth of the pixel centre. What every other model is compared with.
//
// | key   | default | meaning                          |
// | z_min | 0.05 m  | nearer points give no return     |
// | z_max | 10 m    | farther points give no return    |

#include "sim/noise/depth_grid.hpp"
#include "sim/sensors/models.hpp"

namespace binpick {
namespace {

class IdealSensor : public SensorModel {
 public:
  void visit(ConfigVisitor& v) override {
    v.field("z_min", z_min_, Unit::kLength, "nearer points give no return");
    v.field("z_max", z_max_, Unit::kLength, "farther points give no return");
  }
  void validate() const override { check_depth_range("ideal", z_min_, z_max_); }
  PinholeCamera default_camera() const override { return {}; }
  double z_min() const override { return z_min_; }
  double z_max() const override { return z_max_; }
  StatedNoise stated_noise(const PinholeCamera&) const override { return {}; }

  Image<float> capture(const SensorView& view, Seed, Seed) const override {
    const ExactFrame& exact = view.exact;
    Image<float> depth(exact.depth.width(), exact.depth.height());
    for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = on_grid(exact.depth[i], {0, z_min_, z_max_});
    return depth;
  }

 private:
  double z_min_ = 0.05;
  double z_max_ = 10;
};

}  // namespace

std::unique_ptr<SensorModel> make_ideal_sensor() { return std::make_unique<IdealSensor>(); }

}  // namespace binpick

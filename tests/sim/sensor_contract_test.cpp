// What every sensor model promises, whatever it models. A new registry line is met by these tests at once.
#include <algorithm>

#include "core/error.hpp"
#include "core/primitive.hpp"
#include "sensor_fixtures.hpp"
#include "sim/depth_sensor.hpp"

namespace binpick {
namespace {

using test::same_bits;

struct Variant {
  std::string type, preset;
};

std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const std::string& name : sensor_names()) {
    all.push_back({name, ""});
    for (const std::string& preset : make_sensor(name)->presets()) all.push_back({name, preset});
  }
  return all;
}

// Without one type, for a rule that it does not have.
std::vector<Variant> variants_without(const std::string& type) {
  std::vector<Variant> all = variants();
  std::erase_if(all, [&](const Variant& variant) { return variant.type == type; });
  return all;
}

std::string name_of(const testing::TestParamInfo<Variant>& variant) {
  std::string name = variant.param.type + (variant.param.preset.empty() ? "" : "_" + variant.param.preset);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

Pose at(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}

RenderItem item(TriangleMesh mesh, const Pose& X_WO, std::int32_t id) {
  return {std::make_shared<const TriangleMesh>(std::move(mesh)), X_WO, id, {}};
}

class SensorContract : public testing::TestWithParam<Variant> {
 protected:
  SensorContract() : sensor_(make()), camera_(test::cropped(sensor_->default_camera(), 320, 240)) {
    // A floor at 0.9 m with a ball, a plate, something too near and something too far; the floor ends inside the image.
    scene_.items = {item(mesh_of(Primitive::box({0.35, 1, 0.01})), at(-0.02, 0, 0.905), kIdTable),
                    item(mesh_of(Primitive::sphere(0.05), 64), at(0.03, 0.02, 0.8), 0),
                    item(mesh_of(Primitive::box({0.1, 0.06, 0.016})), at(-0.07, -0.05, 0.892), 1),
                    item(mesh_of(Primitive::sphere(0.01)), at(-0.01, 0.02, 0.1), 2),
                    item(mesh_of(Primitive::box({1, 1, 0.01})), at(0.5, 0, 9.5), kIdBin)};
    exact_ = renderer_->render(scene_, camera_, Pose::Identity(), 0.02, 12);
  }
  std::unique_ptr<SensorModel> make(const std::string& more = "") const {
    const std::string preset = GetParam().preset.empty() ? "" : "preset: " + GetParam().preset + "\n";
    return test::sensor(GetParam().type, preset + more);
  }
  /// What `sensor` delivers of `exact`; a second imager or a projector sees `scene`.
  Image<float> shoot(const SensorModel& sensor, const ExactFrame& exact, const RenderScene& scene, Seed camera_seed,
                     Seed frame_seed) const {
    const auto from_device = [&](const PinholeCamera& device, const Pose& X_CD, double near, double far) {
      return renderer_->render(scene, device, X_CD, near, far);
    };
    return sensor.capture(SensorView{exact, camera_, from_device, 1}, camera_seed, frame_seed);
  }
  Image<float> shoot(const SensorModel& sensor) const { return shoot(sensor, exact_, scene_, Seed{1}, Seed{2}); }
  Image<float> shoot(std::uint64_t camera = 1, std::uint64_t frame = 2) const {
    return shoot(*sensor_, exact_, scene_, Seed{camera}, Seed{frame});
  }

  std::unique_ptr<DepthRenderer> renderer_ = make_osmesa_renderer();
  std::unique_ptr<SensorModel> sensor_;
  PinholeCamera camera_;
  RenderScene scene_;
  ExactFrame exact_;
};

TEST_P(SensorContract, SameSeedsGiveTheSameBits) {
  const Image<float> once = shoot(), again = shoot();
  EXPECT_TRUE(same_bits(once, again));
  EXPECT_TRUE(same_bits(once, shoot(*make())));
}

TEST_P(SensorContract, OtherFrameSeedGivesAnotherImage) {
  EXPECT_EQ(same_bits(shoot(1, 2), shoot(1, 3)), GetParam().type == "ideal");
}

TEST_P(SensorContract, NothingOutsideTheRangeAndNothingFromNothing) {
  const Image<float> depth = shoot();
  std::size_t valid = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (std::isnan(depth[i])) continue;
    ++valid;
    ASSERT_GE(depth[i], sensor_->z_min());
    ASSERT_LE(depth[i], sensor_->z_max());
  }
  EXPECT_GT(valid, depth.size() / 3);
  const Image<float> empty = shoot(*sensor_, test::nothing(camera_), {}, Seed{1}, Seed{2});
  EXPECT_EQ(test::fill(empty), 0);
}

TEST_P(SensorContract, DepthIsNearTheTruth) {
  const Image<float> depth = shoot();
  std::size_t valid = 0, near = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (exact_.ids[i] != kIdTable || std::isnan(depth[i])) continue;
    ++valid;
    near += std::abs(depth[i] - exact_.depth[i]) < 0.05;  // an out-of-box bias is 15 mm here (1 sigma)
  }
  ASSERT_GT(valid, depth.size() / 4);
  EXPECT_GT(static_cast<double>(near), 0.97 * static_cast<double>(valid));  // outlines may report their neighbour
}

// `ideal` has no grid.
class GridContract : public SensorContract {};

TEST_P(GridContract, DepthLiesOnItsGrid) {
  const Image<float> depth = shoot(*make("depth_unit: 1 mm\n"));
  for (const float z : depth) {
    if (!std::isnan(z)) {
      ASSERT_FLOAT_EQ(z, static_cast<float>(std::round(z * 1000) / 1000));
    }
  }
}

// If a value depended on what was drawn for other pixels, emptying the lower rows would change the upper ones.
// active_stereo is left out: its exposure is metered over the whole image and its matcher smooths along whole rows and
// columns, so that a pixel rightly depends on all the others. Its own test holds its noise to this rule.
class PixelContract : public SensorContract {};

TEST_P(PixelContract, PixelsDoNotDependOnTheOthersInTheirStreams) {
  const Image<float> whole = shoot();
  ExactFrame cut = exact_;
  const ExactFrame empty = test::nothing(camera_);
  const std::size_t from = exact_.depth.size() * 3 / 4;
  std::copy(empty.depth.begin() + from, empty.depth.end(), cut.depth.begin() + from);
  std::copy(empty.ids.begin() + from, empty.ids.end(), cut.ids.begin() + from);
  std::copy(empty.normals_C.begin() + from, empty.normals_C.end(), cut.normals_C.begin() + from);
  const Image<float> part = shoot(*sensor_, cut, scene_, Seed{1}, Seed{2});
  const std::size_t untouched = from - 8 * static_cast<std::size_t>(camera_.width);  // windows and jitter reach less
  for (std::size_t i = 0; i < untouched; ++i)
    ASSERT_TRUE(whole[i] == part[i] || (std::isnan(whole[i]) && std::isnan(part[i]))) << i;
}

TEST_P(SensorContract, WrittenConfigurationIsTheSameSensor) {
  const auto sensor = make(GetParam().type == "ideal" ? "z_max: 3\n" : "z_max: 3\ndepth_unit: 0.5 mm\n");
  const std::string text = write_yaml([&](ConfigVisitor& v) { sensor->visit(v); });
  const auto back = test::sensor(GetParam().type, text);
  EXPECT_TRUE(same_bits(shoot(*sensor), shoot(*back)));
  EXPECT_EQ(back->z_max(), 3);
  EXPECT_EQ(back->stated_noise(camera_).sigma(1), sensor->stated_noise(camera_).sigma(1));
}

TEST_P(SensorContract, BadValuesAreSpecErrors) {
  EXPECT_THROW(make("z_min: 3\nz_max: 2\n"), SpecError);
  EXPECT_THROW(make("z_mim: 0.2\n"), SpecError);
  EXPECT_THROW(make("z_min: -1\n"), SpecError);
  EXPECT_NO_THROW(sensor_->default_camera().validate());
}

INSTANTIATE_TEST_SUITE_P(Registry, SensorContract, testing::ValuesIn(variants()), name_of);
INSTANTIATE_TEST_SUITE_P(Registry, GridContract, testing::ValuesIn(variants_without("ideal")), name_of);
INSTANTIATE_TEST_SUITE_P(Registry, PixelContract, testing::ValuesIn(variants_without("active_stereo")), name_of);

TEST(SensorRegistry, UnknownNamesSayWhatIsNear) {
  try {
    make_sensor("dispartiy");
    FAIL();
  } catch (const SpecError& e) {
    EXPECT_NE(std::string(e.what()).find("'disparity'"), std::string::npos) << e.what();
  }
  EXPECT_THROW(test::sensor("disparity", "preset: d436"), SpecError);
}

TEST(SensorPresets, LaterKeysOverrideThePresetWhereverItStands) {
  const auto first = test::sensor("disparity", "preset: d415_1280\nz_min: 0.3\n");
  const auto last = test::sensor("disparity", "z_min: 0.3\npreset: d415_1280\n");
  EXPECT_EQ(first->z_min(), 0.3);
  EXPECT_EQ(last->z_min(), 0.3);
  EXPECT_EQ(first->default_camera().width, 1280);
}

// ---- depth_sensor
// ------------------------------------------------------------------------------------------------------

TEST(DepthSensor, FrameSaysWhatIsBelievedAndTruthStaysApart) {
  const auto renderer = make_osmesa_renderer();
  const auto sensor = test::sensor("ideal", "");
  const PinholeCamera camera = test::cropped(PinholeCamera{}, 200, 120);
  const Pose X_WC = at(0, 0, 0.7) * pose_from_xyz_rpy({0, 0, 0}, {M_PI, 0, 0});
  const Pose X_WC_believed = at(0.002, 0, 0) * X_WC;
  RenderScene scene;
  scene.items = {item(mesh_of(Primitive::box({0.1, 0.06, 0.016})), at(0, 0, 0.008), 0)};
  const Capture capture = capture_depth(*renderer, *sensor, scene, 2, camera, X_WC, X_WC_believed, Seed{1}, Seed{2});
  EXPECT_TRUE(capture.frame.X_WC.isApprox(X_WC_believed, 0));
  EXPECT_NEAR(capture.frame.depth(100, 60), 0.684, 1e-6);
  ASSERT_EQ(capture.visibility.size(), 2u);
  EXPECT_EQ(capture.visibility[0].fraction(), 1);
  EXPECT_EQ(capture.visibility[1].fraction(), 0);
  const std::uint64_t hash = frame_hash(capture.frame);
  DepthFrame other = capture.frame;
  EXPECT_EQ(frame_hash(other), hash);
  other.depth(100, 60) = std::nextafter(other.depth(100, 60), 1.0f);
  EXPECT_NE(frame_hash(other), hash);
  other = capture.frame;
  other.camera.fx += 1;
  EXPECT_NE(frame_hash(other), hash);
}

}  // namespace
}  // namespace binpick

// The table of cameras against the figures that its sources derive from one another (physical_models A1, A2).
#include "sim/sensors/camera_table.hpp"

#include <cmath>
#include <set>

#include "sensor_fixtures.hpp"

namespace binpick {
namespace {

TEST(CameraTable, RowsAreWhole) {
  std::set<std::string> names;
  for (const DepthCamera& row : camera_table()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_NO_THROW(row.camera.validate()) << row.name;
    EXPECT_EQ(row.camera.cx, 0.5 * (row.camera.width - 1)) << row.name;
    EXPECT_EQ(row.camera.cy, 0.5 * (row.camera.height - 1)) << row.name;
    EXPECT_LT(row.z_min, row.z_max) << row.name;
    EXPECT_FALSE(row.source.empty()) << row.name;
  }
}

TEST(CameraTable, NearestRangeIsASearchOf126Disparities) {
  for (const DepthCamera& row : camera_table()) {
    if (!(row.subpixel_noise > 0)) continue;
    // Published values of the D405 are 1.08 to 1.15 times f B / 126 (A1).
    EXPECT_NEAR(row.z_min, row.fB() / 126, row.name.starts_with("d405") ? 0.15 * row.z_min : 1e-3) << row.name;
  }
}

struct StatedSigma {
  const char* camera;
  double millimetres[4];  // at 0.3, 0.5, 0.7 and 1 m
};

// The second table of A2, its figures rounded to three digits or 5 um.
TEST(CameraTable, StereoNoiseIsThatOfTheReference) {
  const double ranges[] = {0.3, 0.5, 0.7, 1.0};
  for (const StatedSigma& stated : {StatedSigma{"d415_1280", {0.14, 0.40, 0.77, 1.58}},
                                    {"d435_848", {0.33, 0.93, 1.82, 3.72}},
                                    {"d435_1280", {0.23, 0.63, 1.23, 2.50}},
                                    {"d405_848", {0.93, 2.58, 5.06, 10.3}},
                                    {"d405_1280", {0.62, 1.71, 3.36, 6.86}}}) {
    const auto sensor = test::sensor("disparity", std::string("preset: ") + stated.camera);
    const StatedNoise noise = sensor->stated_noise(sensor->default_camera());
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(noise.sigma(ranges[i]), stated.millimetres[i] * 1e-3, std::max(5.1e-6, 6e-3 * noise.sigma(ranges[i])))
          << stated.camera << " at " << ranges[i];
  }
}

TEST(CameraTable, StatedNoiseFollowsTheIntrinsicsInUse) {
  const auto sensor = test::sensor("disparity", "preset: d435_848\n");
  PinholeCamera twice = sensor->default_camera();
  twice.fx *= 2;
  EXPECT_DOUBLE_EQ(sensor->stated_noise(twice).sigma(1), 0.5 * sensor->stated_noise(sensor->default_camera()).sigma(1));
}

TEST(CameraTable, OutOfTheBoxIsTheSameCameraWithBiasAndACoarserUnit) {
  for (const std::string name : {"d435_848", "d435_1280", "d415_1280"}) {
    const auto calibrated = test::sensor("disparity", "preset: " + name);
    const auto raw = test::sensor("disparity", "preset: " + name + "_out_of_box");
    const std::string back = "bias_sigma: 0.03\nripple: 0.03\ndepth_unit: 0.1 mm\n";
    const auto turned_back = test::sensor("disparity", "preset: " + name + "_out_of_box\n" + back);
    const PinholeCamera camera = test::cropped(calibrated->default_camera(), 160, 30);
    const ExactFrame exact = test::wall(camera, 0.7, 0.3);
    const auto shoot = [&](const SensorModel& s) { return s.capture(exact, camera, Seed{1}, Seed{2}); };
    EXPECT_TRUE(test::same_bits(shoot(*calibrated), shoot(*turned_back))) << name;
    EXPECT_FALSE(test::same_bits(shoot(*calibrated), shoot(*raw))) << name;
  }
}

}  // namespace
}  // namespace binpick

// White noise on depth: the sigma that is asked for, check V-A3 (Kinect), and the exactness of `ideal`.
#include "sensor_fixtures.hpp"

namespace binpick {
namespace {

double wall_sigma(const SensorModel& sensor, const PinholeCamera& camera, double z, double tilt = 0) {
  const ExactFrame exact = test::wall(camera, z, tilt);
  const Image<float> depth = sensor.capture(exact, camera, Seed{11}, Seed{12});
  double squares = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) squares += std::pow(depth[i] - exact.depth[i], 2);
  return std::sqrt(squares / static_cast<double>(depth.size()));
}

TEST(GaussZ, StereoSigma) {
  const auto sensor = test::sensor("gauss_z", "");
  const PinholeCamera camera = test::cropped(PinholeCamera{}, 200, 150);
  for (const double z : {0.5, 0.7, 1.0}) {
    const double sigma = z * z * 0.08 / (430.1 * 0.0501);
    EXPECT_NEAR(wall_sigma(*sensor, camera, z), sigma, 0.02 * sigma);  // 30000 samples: 0.4 % of sampling error
    EXPECT_DOUBLE_EQ(sensor->stated_noise(camera).sigma(z), sigma);
  }
}

TEST(GaussZ, VA3_KinectCurve) {
  const auto sensor = test::sensor("gauss_z", "preset: kinect_v1\ndepth_unit: 0\n");
  const PinholeCamera camera = test::cropped(sensor->default_camera(), 200, 150);
  EXPECT_NEAR(wall_sigma(*sensor, camera, 0.5), 1.22e-3, 0.05 * 1.22e-3);
  EXPECT_NEAR(wall_sigma(*sensor, camera, 0.7), 1.37e-3, 0.05 * 1.37e-3);
  EXPECT_NEAR(wall_sigma(*sensor, camera, 1.0), 1.88e-3, 0.05 * 1.88e-3);
  const PinholeCamera narrow = test::cropped({640, 480, 20000, 20000, 0, 0}, 100, 100);
  const double slanted = 75 * M_PI / 180;
  // 0.0001 / sqrt(1) x (75 / 15)^2 = 2.5 mm more.
  EXPECT_NEAR(wall_sigma(*sensor, narrow, 1.0, slanted), 1.88e-3 + 2.5e-3, 0.05 * 4.38e-3);
}

TEST(GaussZ, SigmaOfEveryPresetWhereItsSourceStatesOne) {
  const struct {
    const char* preset;
    double z, sigma;
  } stated[] = {{"azure_kinect", 0.4, 0.5e-3}, {"azure_kinect", 0.7, 0.7e-3}, {"azure_kinect", 1.5, 1.5e-3},
                {"zivid_2", 0.7, 0.055e-3},    {"phoxi_m", 0.65, 0.10e-3},    {"sigma_0.5mm", 0.3, 0.5e-3},
                {"sigma_0.5mm", 1.8, 0.5e-3}};
  for (const auto& s : stated) {
    const auto sensor = test::sensor("gauss_z", std::string("depth_unit: 0\npreset: ") + s.preset);
    const PinholeCamera camera = test::cropped(sensor->default_camera(), 200, 150);
    EXPECT_NEAR(wall_sigma(*sensor, camera, s.z), s.sigma, 0.02 * s.sigma) << s.preset << " at " << s.z;
  }
}

// BlenderProc's two rules for the Azure Kinect: the rim of a step deeper than 0.8 m, and what is darker than 15/255.
TEST(GaussZ, AzureLosesDeepRimsAndDarkPixels) {
  const auto sensor = test::sensor("gauss_z", "preset: azure_kinect\n");
  const PinholeCamera camera = test::cropped(sensor->default_camera(), 60, 20);
  for (const double behind : {1.35, 1.45}) {  // 0.75 and 0.85 m behind the plate
    ExactFrame exact = test::wall(camera, behind);
    test::add_wall(exact, camera, 0.6, 0, 20, 40);
    const Image<float> depth = sensor->capture(exact, camera, Seed{1}, Seed{2});
    for (int u = 0; u < 60; ++u) {
      const bool rim = u == 19 || u == 20 || u == 39 || u == 40;
      EXPECT_EQ(std::isnan(depth(u, 10)), rim && behind > 1.4) << u << " before " << behind;
    }
  }
  ExactFrame exact = test::wall(camera, 0.6);
  exact.materials.set(0, Material{0.055, 0, 0.3});
  EXPECT_EQ(test::fill(sensor->capture(exact, camera, Seed{1}, Seed{2})), 0);
  exact.materials.set(0, Material{0.062, 0, 0.3});
  EXPECT_EQ(test::fill(sensor->capture(exact, camera, Seed{1}, Seed{2})), 1);
}

TEST(GaussZ, NoiseIsWhite) {
  const auto sensor = test::sensor("gauss_z", "depth_unit: 0\n");
  const PinholeCamera camera = test::cropped(PinholeCamera{}, 200, 150);
  const Image<float> depth = sensor->capture(test::wall(camera, 0.7), camera, Seed{1}, Seed{2});
  double lag0 = 0, across = 0, down = 0;
  for (int v = 0; v + 1 < depth.height(); ++v)
    for (int u = 0; u + 1 < depth.width(); ++u) {
      const double e = depth(u, v) - 0.7;
      lag0 += e * e;
      across += e * (depth(u + 1, v) - 0.7);
      down += e * (depth(u, v + 1) - 0.7);
    }
  EXPECT_NEAR(across / lag0, 0, 4 / std::sqrt(30000.0));
  EXPECT_NEAR(down / lag0, 0, 4 / std::sqrt(30000.0));
}

TEST(Ideal, IsTheExactDepthWithinItsRange) {
  const PinholeCamera camera = test::cropped(PinholeCamera{}, 100, 60);
  const auto sensor = test::sensor("ideal", "z_min: 0.5\nz_max: 0.7\n");
  const ExactFrame exact = test::wall(camera, 0.6, 1.2);
  const Image<float> depth = sensor->capture(exact, camera, Seed{1}, Seed{2});
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (exact.depth[i] >= 0.5f && exact.depth[i] <= 0.7f)
      ASSERT_EQ(depth[i], exact.depth[i]);
    else
      ASSERT_TRUE(std::isnan(depth[i]));
  }
}

}  // namespace
}  // namespace binpick

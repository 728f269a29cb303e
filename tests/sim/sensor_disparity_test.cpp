// The stereo model against its formulas: checks V-A1, V-A2, V-A4, V-A5, V-A6 and V-A8 of the reference, and one test
// for each remaining term.
#include <Eigen/Dense>
#include <set>

#include "sensor_fixtures.hpp"

namespace binpick {
namespace {

using test::bare_disparity;
using test::cropped;

constexpr int kSeeds = 20;

struct CameraCase {
  const char* preset;
  PinholeCamera camera;
  double baseline;
  double fB() const { return camera.fx * baseline; }
};

const CameraCase kD435{"d435_848", cropped({848, 480, 430.1, 430.1, 0, 0}, 170, 96), 0.0501};
const CameraCase kD415{"d415_1280", cropped({1280, 720, 920, 920, 0, 0}, 256, 144), 0.055};

// Only the noise field, 1/32 px and 0.1 mm are on.
std::unique_ptr<SensorModel> noise_only(const CameraCase& c) {
  return bare_disparity(c.preset, "subpixel_noise: 0.08\ndepth_unit: 0.1 mm\nz_max: 3\n");
}

// Residuals of the least-squares plane z = a + b u + c v.
std::vector<double> plane_residuals(const Image<float>& depth) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  const auto row = [&](int u, int v) { return Eigen::Vector3d(1, (u - 80) / 100.0, (v - 50) / 100.0); };
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u) {
      A += row(u, v) * row(u, v).transpose();
      b += row(u, v) * depth(u, v);
    }
  const Eigen::Vector3d x = A.ldlt().solve(b);
  std::vector<double> residuals;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u) residuals.push_back(depth(u, v) - x.dot(row(u, v)));
  return residuals;
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x * x;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

struct WallNoise {
  double plane_rms;     // m
  double subpixel_rms;  // px, the RealSense depth-quality metric
};

// Mean over kSeeds cameras and frames.
WallNoise wall_noise(const CameraCase& c, double z) {
  const auto sensor = noise_only(c);
  const ExactFrame exact = test::wall(c.camera, z);
  WallNoise mean{0, 0};
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Image<float> depth = sensor->capture(exact, c.camera, Seed{seed}.child("camera"), Seed{seed}.child("frame"));
    const std::vector<double> residuals = plane_residuals(depth);
    std::vector<double> pixels;
    for (std::size_t i = 0; i < residuals.size(); ++i)
      pixels.push_back(c.fB() / depth[i] - c.fB() / (depth[i] - residuals[i]));
    mean.plane_rms += rms(residuals) / kSeeds;
    mean.subpixel_rms += rms(pixels) / kSeeds;
  }
  return mean;
}

TEST(DisparityNoise, VA1_WallNoiseAtThreeRanges) {
  const double ranges[] = {0.5, 0.7, 1.0};
  const double d435[] = {0.93e-3, 1.82e-3, 3.72e-3}, d415[] = {0.40e-3, 0.77e-3, 1.58e-3};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(wall_noise(kD435, ranges[i]).plane_rms, d435[i], 0.05 * d435[i]) << ranges[i];
    EXPECT_NEAR(wall_noise(kD415, ranges[i]).plane_rms, d415[i], 0.05 * d415[i]) << ranges[i];
  }
}

TEST(DisparityNoise, VA2_NoiseGrowsWithTheSquareOfRange) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double ranges[] = {0.4, 0.6, 0.9, 1.35, 2.0};
  for (const double z : ranges) {
    const WallNoise noise = wall_noise(kD435, z);
    EXPECT_NEAR(noise.subpixel_rms, 0.08, 0.03 * 0.08) << z;
    const double x = std::log(z), y = std::log(noise.plane_rms);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  EXPECT_NEAR((5 * sxy - sx * sy) / (5 * sxx - sx * sx), 2.0, 0.05);
}

TEST(DisparityNoise, VA6_CorrelationInSpaceAndTime) {
  const auto sensor = noise_only(kD435);
  const ExactFrame exact = test::wall(kD435.camera, 0.7);
  constexpr int kFrames = 40, kCameras = 12;
  double lag0 = 0, lag1 = 0, lag8 = 0, single = 0, averaged = 0;
  for (std::uint64_t camera = 0; camera < kCameras; ++camera) {
    Image<double> sum(kD435.camera.width, kD435.camera.height, 0.0);
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
      const Image<float> depth = sensor->capture(exact, kD435.camera, Seed{camera}, Seed{1000 * camera + frame});
      for (int v = 0; v < depth.height(); ++v)
        for (int u = 0; u < depth.width(); ++u) {
          const double e = depth(u, v) - 0.7;
          sum(u, v) += e;
          single += e * e;
          if (u + 8 >= depth.width()) continue;
          lag0 += e * e;
          lag1 += e * (depth(u + 1, v) - 0.7);
          lag8 += e * (depth(u + 8, v) - 0.7);
        }
    }
    for (const double s : sum) averaged += s / kFrames * (s / kFrames) * kFrames;  // weighed like the single frames
  }
  EXPECT_GT(lag1 / lag0, 0.7);
  EXPECT_LT(lag8 / lag0, 0.1);
  // sqrt(0.5 + 0.5 / 40) = 0.716. Twelve cameras leave about 1.5 % of sampling error.
  EXPECT_NEAR(std::sqrt(averaged / single), 0.716, 0.03);
}

TEST(DisparityNoise, FixedShareZeroAveragesOut) {
  const auto sensor = bare_disparity("d435_848", "subpixel_noise: 0.08\nfixed_share: 0\ncorrelation_length: 0\n");
  const PinholeCamera camera = cropped(PinholeCamera{}, 60, 40);
  const ExactFrame exact = test::wall(camera, 0.7);
  Image<double> sum(60, 40, 0.0);
  double single = 0, averaged = 0;
  for (std::uint64_t frame = 0; frame < 25; ++frame) {
    const Image<float> depth = sensor->capture(exact, camera, Seed{1}, Seed{frame});
    for (std::size_t i = 0; i < depth.size(); ++i) {
      sum[i] += (depth[i] - 0.7) / 25;
      single += (depth[i] - 0.7) * (depth[i] - 0.7) / 25;
    }
  }
  for (const double s : sum) averaged += s * s;
  EXPECT_NEAR(std::sqrt(averaged / single), 0.2, 0.02);  // 1 / sqrt(25)
}

// ---- shadow
// ------------------------------------------------------------------------------------------------------------

struct ShadowCase {
  const char* preset;
  double f, baseline, expected;
};

class Shadow : public testing::TestWithParam<ShadowCase> {};

// V-A4: a plate at 450 mm before a wall at 500 mm.
TEST_P(Shadow, VA4_WidthOnTheLeftAndNothingOnTheRight) {
  const ShadowCase& c = GetParam();
  const PinholeCamera camera = cropped({0, 0, c.f, c.f, 0, 0}, 640, 16);
  const auto sensor = bare_disparity(c.preset, "occlusion: true\nbaseline: " + std::to_string(c.baseline) + "\n");
  ExactFrame exact = test::wall(camera, 0.5);
  test::add_wall(exact, camera, 0.45, 0, 300, 380);
  const Image<float> depth = sensor->capture(exact, camera, Seed{1}, Seed{2});
  const int out_of_view = static_cast<int>(std::ceil(c.f * c.baseline / 0.5));  // left of the second image
  for (int v = 0; v < camera.height; ++v) {
    int left = 0, right = 0;
    for (int u = out_of_view; u < 340; ++u) left += std::isnan(depth(u, v));
    for (int u = 340; u < camera.width; ++u) right += std::isnan(depth(u, v));
    ASSERT_NEAR(left, c.expected, 1.0) << "row " << v;
    ASSERT_EQ(right, 0) << "row " << v;
    ASSERT_TRUE(std::isnan(depth(299, v)));  // it touches the plate
    ASSERT_FALSE(std::isnan(depth(300, v)));
  }
}

INSTANTIATE_TEST_SUITE_P(Cameras, Shadow,
                         testing::Values(ShadowCase{"d415_1280", 920, 0.055, 11.2},
                                         ShadowCase{"d435_848", 430.1, 0.0501, 4.8},
                                         ShadowCase{"d435_848", 639, 0.05, 7.1}));

TEST(DisparityShadow, SlantedWallsAndAFlatFloorCastNone) {
  const PinholeCamera camera = cropped(PinholeCamera{}, 300, 12);
  const auto sensor = bare_disparity("d435_848", "occlusion: true\n");
  for (const double tilt : {-1.2, -0.6, 0.0, 0.6, 1.2}) {
    const ExactFrame exact = test::wall(camera, 0.8, tilt);
    const Image<float> depth = sensor->capture(exact, camera, Seed{1}, Seed{2});
    for (int u = 100; u < camera.width; ++u) {  // the second image begins before column 100
      if (exact.depth(u, 5) < 1.9f && exact.depth(u, 5) > 0.3f) {
        ASSERT_FALSE(std::isnan(depth(u, 5))) << "tilt " << tilt << " column " << u;
      }
    }
  }
}

TEST(DisparityShadow, ProjectorCastsItsOwn) {
  const PinholeCamera camera = cropped(PinholeCamera{}, 300, 8);
  ExactFrame exact = test::wall(camera, 0.5);
  test::add_wall(exact, camera, 0.3, 0, 150, 200);
  const auto sensor = bare_disparity("d435_848", "projector_baseline: 29 mm\n");
  const Image<float> depth = sensor->capture(exact, camera, Seed{1}, Seed{2});
  int holes = 0;
  for (int u = 0; u < camera.width; ++u) holes += std::isnan(depth(u, 4));
  EXPECT_NEAR(holes, 430.1 * 0.029 * (1 / 0.3 - 1 / 0.5), 1.0);
}

// ---- steps, range, bias
// ------------------------------------------------------------------------------------------------

TEST(DisparityGrid, VA5_StepsOfDepthOnATiltedWall) {
  const auto sensor = bare_disparity("d435_848", "depth_unit: 0\n");
  const ExactFrame exact = test::wall(kD435.camera, 1.0, 0.3);
  std::set<float> values;
  for (const float z : sensor->capture(exact, kD435.camera, Seed{1}, Seed{2}))
    if (std::abs(z - 1.0f) < 0.02f) values.insert(z);
  ASSERT_GT(values.size(), 20u);
  for (auto it = values.begin(), next = std::next(it); next != values.end(); ++it, ++next) {
    const double z = 0.5 * (*it + *next);
    ASSERT_NEAR(*next - *it, 1.45e-3 * z * z, 0.01e-3) << z;
  }
}

TEST(DisparityGrid, VA5_NothingBelowTheNearestRange) {
  const auto sensor = test::sensor("disparity", "preset: d415_1280\n");
  const ExactFrame exact = test::wall(kD415.camera, 0.41, 0.4);
  const Image<float> depth = sensor->capture(exact, kD415.camera, Seed{1}, Seed{2});
  int nearer = 0, missing = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!std::isnan(depth[i])) {
      ASSERT_GE(depth[i], 0.402f);
    }
    nearer += exact.depth[i] < 0.39f;
    missing += exact.depth[i] < 0.39f && std::isnan(depth[i]);
  }
  ASSERT_GT(nearer, 500);
  EXPECT_EQ(missing, nearer);
}

double mean_error(const char* bias) {
  const auto sensor = bare_disparity("d435_848", std::string("bias_mean: ") + bias + "\n");
  const ExactFrame exact = test::wall(kD435.camera, 1.0, 0.05);  // leaning, so that the steps average out
  const Image<float> depth = sensor->capture(exact, kD435.camera, Seed{1}, Seed{2});
  double sum = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) sum += depth[i] - exact.depth[i];
  return sum / static_cast<double>(depth.size());
}

TEST(DisparityBias, VA8_MeanErrorAndSign) {
  const double nearer = mean_error("0.4"), farther = mean_error("-0.4");
  EXPECT_LT(nearer, 0);
  EXPECT_GT(farther, 0);
  EXPECT_NEAR((farther - nearer) / 2, 18.6e-3, 0.02 * 18.6e-3);
  // The first order formula is 2 % off at this size; z - f B / (d + dd) is exact.
  const double d = kD435.fB();
  EXPECT_NEAR(nearer, kD435.fB() / (d + 0.4) - 1, 0.02 * 18.6e-3);
  EXPECT_NEAR(farther, kD435.fB() / (d - 0.4) - 1, 0.02 * 18.6e-3);
}

TEST(DisparityBias, IsDrawnOnceForACamera) {
  const auto sensor = bare_disparity("d435_848", "bias_sigma: 0.3\ndisparity_step: 0\ndepth_unit: 0\n");
  const PinholeCamera camera = cropped(PinholeCamera{}, 16, 16);
  const ExactFrame exact = test::wall(camera, 1.0);
  double sum = 0, squares = 0;
  constexpr int kCameras = 400;
  for (std::uint64_t k = 0; k < kCameras; ++k) {
    const float z = sensor->capture(exact, camera, Seed{k}, Seed{1})(8, 8);
    ASSERT_EQ(z, sensor->capture(exact, camera, Seed{k}, Seed{2})(3, 5));
    const double dd = kD435.fB() / z - kD435.fB();
    sum += dd, squares += dd * dd;
  }
  EXPECT_NEAR(sum / kCameras, 0, 4 * 0.3 / std::sqrt(kCameras));
  EXPECT_NEAR(std::sqrt(squares / kCameras), 0.3, 4 * 0.3 / std::sqrt(2.0 * kCameras));
}

TEST(DisparityRipple, IsASineOfTheDisparity) {
  const auto sensor = bare_disparity("d435_848", "ripple: 0.1\ndisparity_step: 0\ndepth_unit: 0\n");
  const ExactFrame exact = test::wall(kD435.camera, 0.8, 0.4);
  const Image<float> depth = sensor->capture(exact, kD435.camera, Seed{1}, Seed{2});
  for (std::size_t i = 0; i < depth.size(); i += 7) {
    const double d = kD435.fB() / exact.depth[i];
    ASSERT_NEAR(kD435.fB() / depth[i] - d, 0.1 * std::sin(2 * M_PI * d), 1e-4);
  }
}

}  // namespace
}  // namespace binpick

// The measures of depth quality on images whose measure is known on paper.
#include "sim/depth_quality.hpp"

#include "core/random.hpp"
#include "sensor_fixtures.hpp"

namespace binpick {
namespace {

const PinholeCamera kCamera = test::cropped(PinholeCamera{}, 120, 80);
const ImageRegion kAll{0, 0, 120, 80};

// +a and -a in turn, in a chequered pattern: no plane explains any of it.
Image<float> chequered(const Image<float>& truth, double a) {
  Image<float> depth = truth;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u) depth(u, v) += static_cast<float>((u + v) % 2 == 0 ? a : -a);
  return depth;
}

TEST(DepthQuality, RegionsLieInTheMiddle) {
  const ImageRegion r = centre_region(PinholeCamera{}, 0.2);
  EXPECT_EQ(r.u1 - r.u0, 170);
  EXPECT_EQ(r.v1 - r.v0, 96);
  EXPECT_EQ(r.u0 + r.u1, 848);
  EXPECT_EQ(r.v0 + r.v1, 480);
  EXPECT_EQ(centre_region(kCamera, 5000, 5000).pixels(), 120 * 80);
}

TEST(DepthQuality, AnExactWallHasNoError) {
  for (const double tilt : {0.0, 0.5, -1.0}) {
    const Image<float> depth = test::wall(kCamera, 0.7, tilt).depth;
    const auto plane = fit_wall(depth, kCamera, kAll);
    ASSERT_TRUE(plane);
    EXPECT_TRUE(plane->normal_C.isApprox(Eigen::Vector3d(-std::sin(tilt), 0, std::cos(tilt)), 1e-5)) << tilt;
    EXPECT_NEAR(plane->offset, 0.7 * std::cos(tilt), 1e-6);
    EXPECT_NEAR(plane->depth_at(kCamera, 3, 5), depth(3, 5), 1e-5);
    EXPECT_NEAR(plane_fit_rms(depth, kCamera, kAll), 0, 1e-6);
    EXPECT_NEAR(subpixel_rms(depth, kCamera, kAll, 0.05), 0, 1e-4);
    EXPECT_EQ(z_accuracy(depth, depth, kAll), 0);
    EXPECT_EQ(fill_rate(depth, kAll), 1);
  }
}

TEST(DepthQuality, AChequeredErrorIsItsOwnRms) {
  const Image<float> truth = test::wall(kCamera, 0.8).depth;
  const Image<float> depth = chequered(truth, 1e-3);
  EXPECT_NEAR(plane_fit_rms(depth, kCamera, kAll), 1e-3, 2e-6);
  EXPECT_NEAR(rms_error(depth, truth, kAll), 1e-3, 1e-7);
  EXPECT_NEAR(mean_error(depth, truth, kAll), 0, 1e-8);
  // d = f B / z: an error of 1 mm at 0.8 m is f B 1 mm / 0.64 m^2.
  const double fB = 430.1 * 0.05;
  EXPECT_NEAR(subpixel_rms(depth, kCamera, kAll, 0.05), fB * 1e-3 / 0.64, 1e-3 * fB * 1e-3 / 0.64);
  EXPECT_NEAR(error_correlation(depth, truth, kAll, 0), 1, 1e-12);
  EXPECT_NEAR(error_correlation(depth, truth, kAll, 1), -1, 1e-4);
  EXPECT_NEAR(error_correlation(depth, truth, kAll, 2), 1, 1e-4);
}

TEST(DepthQuality, APlaneTakesUpShiftAndTiltButTheErrorToTruthDoesNot) {
  const Image<float> truth = test::wall(kCamera, 0.8).depth;
  const Image<float> moved = test::wall(kCamera, 0.84).depth;
  EXPECT_NEAR(plane_fit_rms(moved, kCamera, kAll), 0, 1e-6);
  EXPECT_NEAR(z_accuracy(moved, truth, kAll), 0.05, 1e-6);
  EXPECT_NEAR(mean_error(moved, truth, kAll), 0.04, 1e-6);
  EXPECT_NEAR(rms_error(moved, truth, kAll), 0.04, 1e-6);
}

TEST(DepthQuality, TheMedianErrorIgnoresFewWildPixels) {
  const Image<float> truth = test::wall(kCamera, 0.8).depth;
  Image<float> depth = test::wall(kCamera, 0.808).depth;
  for (int u = 0; u < 40; ++u) depth(u, 7) = 3.0f;
  EXPECT_NEAR(z_accuracy(depth, truth, kAll), 0.01, 1e-6);
}

TEST(DepthQuality, MissingPixelsCountInFillAlone) {
  const Image<float> truth = test::wall(kCamera, 0.8).depth;
  Image<float> depth = chequered(truth, 1e-3);
  for (int v = 0; v < 80; ++v)
    for (int u = 0; u < 30; ++u) depth(u, v) = std::nanf("");
  EXPECT_DOUBLE_EQ(fill_rate(depth, kAll), 0.75);
  EXPECT_NEAR(plane_fit_rms(depth, kCamera, kAll), 1e-3, 2e-6);
  EXPECT_NEAR(error_correlation(depth, truth, kAll, 1), -1, 1e-4);
  const Image<float> empty = test::nothing(kCamera).depth;
  EXPECT_EQ(fill_rate(empty, kAll), 0);
  EXPECT_FALSE(fit_wall(empty, kCamera, kAll));
  EXPECT_TRUE(std::isnan(plane_fit_rms(empty, kCamera, kAll)));
  EXPECT_TRUE(std::isnan(z_accuracy(empty, truth, kAll)));
}

TEST(DepthQuality, NoiseOverTimeIsRelativeToDepth) {
  const Image<float> truth = test::wall(kCamera, 0.5).depth;
  std::vector<Image<float>> frames;
  for (int k = 0; k < 40; ++k) {  // +-1 mm in turn: the unbiased deviation is 1 mm sqrt(40 / 39)
    Image<float> frame = truth;
    for (float& z : frame) z += k % 2 == 0 ? 1e-3f : -1e-3f;
    frames.push_back(frame);
  }
  EXPECT_NEAR(temporal_noise(frames, kAll), std::sqrt(40.0 / 39) * 1e-3 / 0.5, 1e-6);
  const Image<float> mean = frame_mean(frames);
  EXPECT_NEAR(rms_error(mean, truth, kAll), 0, 1e-7);
  for (int k = 0; k < 21; ++k) frames[static_cast<std::size_t>(k)] = test::nothing(kCamera).depth;
  EXPECT_TRUE(std::isnan(temporal_noise(frames, kAll)));  // fewer than half have a value
  EXPECT_FALSE(std::isnan(frame_mean(frames)(5, 5)));
}

// White noise of deviation sigma averaged over 25 frames is sigma / 5; neighbours do not correlate.
TEST(DepthQuality, WhiteNoiseAveragesOut) {
  const Image<float> truth = test::wall(kCamera, 0.5).depth;
  std::vector<Image<float>> frames(25, truth);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    Rng rng = Seed{77}.child("frame", k).rng();
    for (float& z : frames[k]) z += static_cast<float>(rng.normal(0, 1e-3));
  }
  EXPECT_NEAR(rms_error(frames[0], truth, kAll), 1e-3, 4 * 1e-3 / std::sqrt(2.0 * kAll.pixels()));
  EXPECT_NEAR(rms_error(frame_mean(frames), truth, kAll), 2e-4, 4 * 2e-4 / std::sqrt(2.0 * kAll.pixels()));
  EXPECT_NEAR(temporal_noise(frames, kAll), 1e-3 / 0.5, 0.03 * 1e-3 / 0.5);
  EXPECT_NEAR(error_correlation(frames[0], truth, kAll, 3), 0, 4 / std::sqrt(1.0 * kAll.pixels()));
}

}  // namespace
}  // namespace binpick

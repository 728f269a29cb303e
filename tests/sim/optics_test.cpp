// The pieces of the optical sensors, each against what is known on paper.
#include <numbers>

#include "scene_fixtures.hpp"
#include "sim/optics/dot_pattern.hpp"
#include "sim/optics/infrared_imager.hpp"
#include "sim/optics/projector_light.hpp"
#include "sim/optics/reflectance.hpp"
#include "sim/optics/subpixel_fit.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;

struct Moments {
  double mean = 0, variance = 0;
};

template <class T>
Moments moments(const Image<T>& image) {
  double sum = 0, square = 0;
  for (const T x : image) {
    sum += x;
    square += static_cast<double>(x) * x;
  }
  const auto n = static_cast<double>(image.size());
  return {sum / n, square / n - sum * sum / n / n};
}

// ---- infrared_imager

TEST(InfraredImager, SpeckleAndThermalNoiseHaveTheirVariances) {
  const Image<float> flat(300, 300, 1.0f);
  const Image<std::uint8_t> grey = expose(flat, 100, {398.12, 0.5, 0.83}, Seed{1}.rng(), Seed{2}.rng(), 1);
  const Moments m = moments(grey);
  // Gamma(k, 1/k) has variance 1/k; rounding to whole levels adds 1/12.
  const double expected = 100.0 * 100 / 398.12 + 0.83 * 0.83 + 1.0 / 12;
  EXPECT_NEAR(m.mean, 100, 0.1);
  EXPECT_NEAR(m.variance, expected, 0.03 * expected);
}

TEST(InfraredImager, NoPixelDependsOnAnotherOrOnThreads) {
  Image<float> radiance(64, 48, 0.5f);
  const auto shoot = [&](int threads) { return expose(radiance, 100, {}, Seed{1}.rng(), Seed{2}.rng(), threads); };
  const Image<std::uint8_t> once = shoot(1), three = shoot(3);
  EXPECT_TRUE(std::equal(once.begin(), once.end(), three.begin()));
  for (int v = 24; v < 48; ++v)
    for (int u = 0; u < 64; ++u) radiance(u, v) = 0;  // the lower half takes no speckle from its streams
  const Image<std::uint8_t> cut = shoot(1);
  EXPECT_TRUE(std::equal(once.begin(), once.begin() + 64 * 24, cut.begin()));
}

TEST(InfraredImager, ExposureHoldsTheMeanOfTheSaturatedImage) {
  Image<float> radiance(301, 280);
  Rng rng = Seed{3}.child("radiance").rng();
  for (float& x : radiance) x = static_cast<float>(std::exp(rng.uniform(-4, 4)));
  const double gain = exposure_for_mean(radiance, 60, 1e6);
  double sum = 0;
  for (const float x : radiance) sum += std::min(gain * x, 255.0);
  EXPECT_NEAR(sum / static_cast<double>(radiance.size()), 60, 2);  // one pixel in seven is metered
  EXPECT_EQ(exposure_for_mean(Image<float>(8, 8, 0.0f), 60, 500), 500);
}

TEST(InfraredImager, BlurKeepsTheLightAndHasItsWidth) {
  Image<float> point(31, 31, 0.0f);
  point(15, 15) = 1;
  blur(point, 0.18);
  double sum = 0, second = 0;
  for (int v = 0; v < 31; ++v)
    for (int u = 0; u < 31; ++u) {
      sum += point(u, v);
      second += point(u, v) * (u - 15) * (u - 15);
    }
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_NEAR(second, 2 * 0.18, 1e-6);
}

// ---- dot_pattern

TEST(DotPattern, HasAsMuchLightAsItsDots) {
  const DotPatternConfig config{0.01, 0.0024, 0.7, 0.4, 0.3};
  const DotPattern pattern(config, Seed{5});
  double sum = 0;
  int samples = 0;
  for (double y = -0.28; y < 0.28; y += 0.0017)
    for (double x = -0.38; x < 0.38; x += 0.0017, ++samples) sum += pattern.at(x, y);
  // density dots of mean brightness 0.8 and volume 2 pi sigma^2 in every cell.
  const double expected = 0.7 * 0.8 * 2 * kPi * 0.0024 * 0.0024 / (0.01 * 0.01);
  EXPECT_NEAR(sum / samples, expected, 0.05 * expected);
  EXPECT_EQ(pattern.at(0.41, 0), 0);
  EXPECT_NE(pattern.at(0.1, 0.1), DotPattern(config, Seed{6}).at(0.1, 0.1));
}

// ---- reflectance and projector_light

TEST(Reflectance, LobePeaksAtTheMirrorAngleAndReturnsItsShare) {
  const Material metal{0.1, 0.6, 0.25};
  const Eigen::Vector3d n = Eigen::Vector3d::UnitZ();
  const auto at = [](double angle) { return Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)); };
  for (const double off : {-0.3, -0.1, 0.1, 0.3})
    EXPECT_LT(reflectance(metal, n, at(0.4), at(-0.4 + off)), reflectance(metal, n, at(0.4), at(-0.4)));
  EXPECT_EQ(reflectance(metal, n, at(1.8), at(0)), 0);  // light from behind
  // Head on: the light sent into the half space, by numbers, is near albedo + specular.
  double sent = 0;
  const int steps = 400;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps * kPi / 2;
    sent += reflectance(metal, n, n, at(t)) * std::cos(t) * 2 * kPi * std::sin(t) * kPi / 2 / steps;
  }
  EXPECT_NEAR(sent, 0.7, 0.05);
}

TEST(ProjectorLight, WallGetsTheLightOfAPointSource) {
  const PinholeCamera camera = test::cropped(PinholeCamera{}, 120, 90);
  const RenderScene scene{{test::wide_wall(0.8, {0.5, 0, 0.3})}};
  const auto renderer = make_osmesa_renderer();
  const ExactFrame exact = renderer->render(scene, camera, Pose::Identity(), 0.05, 3);
  const Pose X_CD = test::place(0.1, 0, 0) * pose_from_xyz_rpy({0, 0, 0}, {0, -0.12, 0});
  const PinholeCamera device = covering_device(camera, X_CD, 430, {0.3, 3}, {1, 1});
  const ProjectorLight light(renderer->render(scene, device, X_CD, 0.05, 3), device, X_CD);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const PixelLight seen = light.at({exact, camera, Pose::Identity()}, u, v);
      const Eigen::Vector3d p = camera.unproject(u, v, 0.8), to_light = X_CD.translation() - p;
      const double r = to_light.norm(), expected = 0.5 / kPi * (0.8 / r) / (r * r);
      ASSERT_NEAR(seen.beam, expected, 1e-5) << u << "," << v;
      ASSERT_NEAR(seen.ambient, 0.5 / kPi, 1e-9);
      ASSERT_LT((device.project(X_CD.inverse() * p) - seen.pixel_D).norm(), 1e-3);
    }
}

// A slope of 80 degrees must not shade itself, whatever the pixels of the projector's depth map.
TEST(ProjectorLight, SteepPlanesAreFreeOfFalseShadows) {
  const PinholeCamera camera = test::cropped(PinholeCamera{}, 160, 120);
  RenderScene scene{{test::wide_wall(0)}};
  scene.items[0].X_WO = test::place(0, 0, 0.7) * pose_from_xyz_rpy({0, 0, 0}, {0.5, 1.3, 0}) * scene.items[0].X_WO;
  const auto renderer = make_osmesa_renderer();
  const ExactFrame exact = renderer->render(scene, camera, Pose::Identity(), 0.05, 3);
  const Pose X_CD = test::place(0.03, 0, 0);
  const PinholeCamera device = covering_device(camera, X_CD, 430, {0.2, 3}, {1, 1});
  const ProjectorLight light(renderer->render(scene, device, X_CD, 0.05, 3), device, X_CD);
  int seen = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const double z = exact.depth(u, v);
      if (!(z > 0.4 && z < 1.2)) continue;
      ++seen;
      ASSERT_NEAR(light.visible(X_CD.inverse() * camera.unproject(u, v, z)), 1, 1e-9) << u << "," << v;
    }
  EXPECT_GT(seen, 1000);
}

// ---- subpixel_fit

// Gaussian dots of 1.2 px at random places of a 160 x 60 strip.
Image<std::uint8_t> dots_seen_from(double offset) {
  Image<float> light(120, 60, 20.0f);
  const Rng rng = Seed{8}.child("dots").rng();
  for (std::uint64_t k = 0; k < 450; ++k) {
    Rng dot = rng.at(k);
    const double x = dot.uniform(-10, 150) - offset, y = dot.uniform(0, 60);
    for (int v = std::max(0, static_cast<int>(y) - 6); v < std::min(60, static_cast<int>(y) + 7); ++v)
      for (int u = std::max(0, static_cast<int>(x) - 6); u < std::min(120, static_cast<int>(x) + 7); ++u)
        light(u, v) += static_cast<float>(90 * std::exp(-((u - x) * (u - x) + (v - y) * (v - y)) / (2 * 1.2 * 1.2)));
  }
  Image<std::uint8_t> grey(120, 60);
  for (std::size_t i = 0; i < grey.size(); ++i)
    grey[i] = static_cast<std::uint8_t>(std::lround(std::min(light[i], 255.0f)));
  return grey;
}

// The ripple of the interpolation stays below that of real cameras (0.03 px, physical_models A3.3).
TEST(SubpixelFit, FindsAFractionOfAPixel) {
  const Image<std::uint8_t> left = dots_seen_from(0);
  for (const double fraction : {-0.4, -0.15, 0.0, 0.25, 0.45}) {
    const Image<std::uint8_t> right = dots_seen_from(20 + fraction);  // right(u - d) = left(u)
    Image<float> disparity(120, 60, 20.0f);
    fit_subpixel(left, right, 7, disparity, 1);
    double sum = 0, square = 0;
    int n = 0;
    for (int v = 5; v < 55; ++v)
      for (int u = 40; u < 110; ++u, ++n) {
        const double e = disparity(u, v) - 20 - fraction;
        sum += e;
        square += e * e;
      }
    EXPECT_NEAR(sum / n, 0, 0.02) << fraction;
    EXPECT_LT(std::sqrt(square / n), 0.03) << fraction;
  }
}

TEST(SubpixelFit, PlainAndSaturatedWindowsAreDropped) {
  Image<std::uint8_t> image(90, 30, 100);
  for (int v = 0; v < 30; ++v)
    for (int u = 30; u < 90; ++u)
      image(u, v) = static_cast<std::uint8_t>(u >= 60 ? 255 - 60 * ((u + v) % 3 == 0) : 100 + 40 * ((u + v) % 2));
  Image<float> disparity(90, 30, 7.0f);
  drop_plain(image, {}, disparity);
  EXPECT_TRUE(std::isnan(disparity(10, 15)));   // plain
  EXPECT_FALSE(std::isnan(disparity(45, 15)));  // textured
  EXPECT_TRUE(std::isnan(disparity(75, 15)));   // two thirds at the limit
}

}  // namespace
}  // namespace binpick

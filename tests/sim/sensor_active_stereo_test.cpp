// The matched stereo camera on rendered scenes: the figures of a wall, the shadow of a step, metal, and what must not
// matter (physical_models A1, V-A4, V-A7).
#include <opencv2/core.hpp>

#include "scene_fixtures.hpp"

namespace binpick {
namespace {

using test::hole_width;
using test::Shot;
using test::wide_wall;

double share_off(const Shot& shot, const ImageRegion& region, double tolerance) {
  int off = 0;
  for (int v = region.v0; v < region.v1; ++v)
    for (int u = region.u0; u < region.u1; ++u) off += std::abs(shot.depth(u, v) - shot.exact.depth(u, v)) > tolerance;
  return static_cast<double>(off) / region.pixels();
}

struct Unit {
  const char* preset;
  double baseline;
};

class ActiveStereo : public testing::TestWithParam<Unit> {
 protected:
  std::unique_ptr<SensorModel> sensor(const std::string& more = "") const {
    return test::sensor("active_stereo", "preset: " + std::string(GetParam().preset) + "\n" + more);
  }
  PinholeCamera camera(int width, int height) const { return test::cropped(sensor()->default_camera(), width, height); }
  double fB() const { return sensor()->default_camera().fx * GetParam().baseline; }
  test::Studio studio_;
};

// V-A7: a Lambertian wall.
TEST_P(ActiveStereo, WallHasTheNoiseAndFillOfARealCamera) {
  const PinholeCamera small = camera(480, 240);
  for (const double z : {0.5, 0.75, 1.0}) {
    const Shot shot = studio_.shoot(*sensor(), {{wide_wall(z)}}, small);
    const ImageRegion fifth = centre_region(small, std::sqrt(0.2));
    const double s = subpixel_rms(shot.depth, small, fifth, GetParam().baseline);
    EXPECT_GT(s, 0.03) << z;
    EXPECT_LT(s, 0.12) << z;
    EXPECT_GT(fill_rate(shot.depth, fifth), 0.98) << z;
    EXPECT_LT(std::abs(z_accuracy(shot.depth, shot.exact.depth, fifth)), 0.03 * z / fB())
        << z;  // a third of a pixel's s
    // No window of dots is taken for another: all but a few pixels are right within one pixel of disparity.
    EXPECT_LT(share_off(shot, fifth, z * z / fB()), 1e-3) << z;
  }
}

// V-A7, V-A4: w = f B (1 / z_near - 1 / z_far) on the left of the foreground, +- half the window; nothing on the right.
TEST_P(ActiveStereo, StepCastsAShadowOnOneSide) {
  const PinholeCamera small = camera(480, 160);
  const double half = 60 / small.fx * 0.45;
  const Shot shot =
      studio_.shoot(*sensor(), {{wide_wall(0.5), test::plate(0.45, {-half, half}, {-2, 2}, 0, {0.6, 0, 0.3})}}, small);
  const double width = fB() * (1 / 0.45 - 1 / 0.5);
  const int left = 180, right = 300;  // the plate's outlines lie at 179.5 and 299.5
  EXPECT_NEAR(hole_width(shot.depth, left - 40, left + 10), width, 3.5);
  EXPECT_LT(hole_width(shot.depth, right - 10, right + 40), 3.5);
}

// The left strip that the right imager does not see is lost, and no more than that.
TEST_P(ActiveStereo, LosesOnlyTheBandThatTheRightImagerDoesNotSee) {
  const PinholeCamera small = camera(320, 120);
  const Shot shot = studio_.shoot(*sensor(), {{wide_wall(0.6)}}, small);
  EXPECT_NEAR(hole_width(shot.depth, 0, 240), fB() / 0.6, 3.5);
}

// Polished metal throws the dots of its highlight back so brightly that both images saturate.
TEST_P(ActiveStereo, MetalLosesPixelsAtItsHighlight) {
  const PinholeCamera small = camera(320, 160);
  // Both a matt and a shining plate lie before a matt wall, so that the exposure is that of the wall.
  const auto shoot = [&](const Material& material) {
    const double x = 40 / small.fx * 0.5, y = 30 / small.fx * 0.5;
    return studio_.shoot(*sensor(), {{wide_wall(0.505), test::plate(0.5, {-x, x}, {-y, y}, 0, material)}}, small);
  };
  const auto lost = [](const Shot& shot) {
    std::size_t empty = 0, all = 0;
    for (std::size_t i = 0; i < shot.depth.size(); ++i) {
      if (shot.exact.ids[i] != 0) continue;
      ++all;
      empty += std::isnan(shot.depth[i]);
    }
    return static_cast<double>(empty) / static_cast<double>(all);
  };
  EXPECT_LT(lost(shoot({0.25, 0, 0.3})), 0.02);
  EXPECT_GT(lost(shoot({0.25, 0.6, 0.1})), 0.3);
}

// Where the projector's light does not reach, only ambient light is left: depth gets rare there, not wrong, and the
// rest of the wall does not notice.
TEST_P(ActiveStereo, ProjectorShadowOnlyWeakensTheMatch) {
  const PinholeCamera small = camera(320, 160);
  const double half = 30 / small.fx * 0.4;
  // With the projector far on the left its shadow falls on the right, where both imagers look past the plate.
  const auto far_projector = sensor("projector_baseline: -0.15\n");
  const Shot shot = studio_.shoot(
      *far_projector, {{wide_wall(0.5), test::plate(0.4, {-half, half}, {-2, 2}, 0, {0.6, 0, 0.3})}}, small);
  const int edge = 190, end = edge + static_cast<int>(small.fx * 0.15 * (1 / 0.4 - 1 / 0.5));
  const int last = std::min(end - 4, 315);
  EXPECT_LT(test::fill_of(shot.depth, edge + 4, last), 0.6);
  for (int v = 0; v < 160; ++v)
    for (int u = edge + 4; u < last; ++u) {
      const double z = shot.depth(u, v);
      EXPECT_TRUE(std::isnan(z) || std::abs(z - 0.5) < 0.02 || std::abs(z - 0.4) < 0.02) << u << "," << v << ": " << z;
    }
  if (end + 8 < 310) {
    EXPECT_GT(test::fill_of(shot.depth, end + 8, 310), 0.98);
  }
}

TEST_P(ActiveStereo, ThreadsAndTheOrderOfItemsDoNotMatter) {
  const PinholeCamera small = camera(200, 120);
  RenderScene scene{{wide_wall(0.7), test::plate(0.6, {-0.05, 0.02}, {-0.04, 0.05}, 0, {0.3, 0.4, 0.2}),
                     test::plate(0.55, {0.04, 0.08}, {-0.02, 0.03}, 1, {0.3, 0, 0.2})}};
  const Shot once = studio_.shoot(*sensor(), scene, small, 1);
  const int before = cv::getNumThreads();
  cv::setNumThreads(1);
  const Shot alone = studio_.shoot(*sensor(), scene, small, 3);
  cv::setNumThreads(2);
  const Shot two = studio_.shoot(*sensor(), scene, small, 2);
  cv::setNumThreads(before);
  std::reverse(scene.items.begin(), scene.items.end());
  const Shot turned = studio_.shoot(*sensor(), scene, small, 1);
  EXPECT_TRUE(test::same_bits(once.depth, alone.depth));
  EXPECT_TRUE(test::same_bits(once.depth, two.depth));
  EXPECT_TRUE(test::same_bits(once.depth, turned.depth));
}

INSTANTIATE_TEST_SUITE_P(Units, ActiveStereo,
                         testing::Values(Unit{"d435_848", 0.0501}, Unit{"d435_1280", 0.05}, Unit{"d415_1280", 0.055}),
                         [](const auto& unit) { return std::string(unit.param.preset); });

TEST(ActiveStereoNoise, SomeStaysWithTheUnitAndSomeChanges) {
  test::Studio studio;
  const auto sensor = test::sensor("active_stereo", "disparity_step: 0\ndepth_unit: 0\n");
  const PinholeCamera small = test::cropped(sensor->default_camera(), 200, 120);
  const RenderScene scene{{wide_wall(0.7)}};
  const auto errors = [&](std::uint64_t unit, std::uint64_t frame) {
    const Shot shot = studio.shoot(*sensor, scene, small, 1, Seed{unit}, Seed{frame});
    std::vector<double> e;
    for (int v = 20; v < 100; ++v)
      for (int u = 60; u < 180; ++u) e.push_back(shot.depth(u, v) - 0.7);
    return e;
  };
  const auto correlation = [](const std::vector<double>& a, const std::vector<double>& b) {
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (std::isnan(a[i]) || std::isnan(b[i])) continue;
      ab += a[i] * b[i];
      aa += a[i] * a[i];
      bb += b[i] * b[i];
    }
    return ab / std::sqrt(aa * bb);
  };
  EXPECT_GT(correlation(errors(1, 1), errors(1, 2)), 0.2);  // half the speckle, and the pattern itself
  EXPECT_LT(correlation(errors(1, 1), errors(1, 2)), 0.9);
  EXPECT_LT(std::abs(correlation(errors(1, 1), errors(2, 1))), 0.2);
}

}  // namespace
}  // namespace binpick

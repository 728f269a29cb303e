// The stripe projector on rendered scenes: its noise from the camera's on paper, periods, both visibilities, light that
// is too strong or too weak, concave corners (physical_models A3.5).
#include <numbers>

#include "scene_fixtures.hpp"
#include "sim/optics/stripe_light.hpp"

namespace binpick {
namespace {

using test::Shot;
using test::wide_wall;

constexpr double kPi = std::numbers::pi;

// ---- phase_shift

TEST(PhaseShift, SamplesGiveBackPhaseAndAmplitude) {
  for (const int steps : {3, 4, 7}) {
    PhaseShift stripes;
    stripes.steps = steps;
    for (double phase = -3.1; phase < 3.1; phase += 0.37) {
      PhaseSums sums;
      for (const auto& shift : stripes.shifts())
        sums.add(5 + 2 * (std::cos(phase) * shift.cosine - std::sin(phase) * shift.sine), shift);
      EXPECT_NEAR(sums.phase(), phase, 1e-12);
      EXPECT_NEAR(sums.amplitude(steps), 2, 1e-12);
    }
  }
}

TEST(PhaseShift, EachFrequencyPicksThePeriodOfTheNext) {
  const PhaseShift stripes{4, 10, 0.42};
  Rng rng = Seed{7}.child("positions").rng();
  for (int i = 0; i < 2000; ++i) {
    const double x = rng.uniform(-0.42, 0.42);
    std::array<double, 3> wrapped;
    for (int f = 0; f < 3; ++f) {
      // An error of 0.9 pi / (ratio + 1) on every phase still finds the period.
      const double phase = stripes.phase(f, x) + rng.uniform(-0.9, 0.9) * kPi / 11 * (f < 2);
      wrapped[static_cast<std::size_t>(f)] = std::remainder(phase, 2 * kPi);
    }
    EXPECT_NEAR(stripes.position(wrapped), x, 1e-9);
  }
}

// ---- interreflection

// Two planes at a right angle, evenly bright: at a distance x from the edge the other one, H long, sends the irradiance
// pi L (1 - x / sqrt(x^2 + H^2)) / 2.
TEST(Interreflection, RightAngledCornerHasItsFormFactor) {
  const PinholeCamera camera{640, 128, 200, 200, 319.5, 63.5};
  RenderScene corner;
  for (const double tilt : {kPi / 4, -kPi / 4}) {
    RenderItem half = test::plate(0, {-3, 3}, {-1, 1}, kIdTable, {1, 0, 0.3});
    half.X_WO = test::place(0, 0, 0.66) * pose_from_xyz_rpy({0, 0, 0}, {tilt, 0, 0}) * half.X_WO;
    corner.items.push_back(half);
  }
  const ExactFrame exact = make_osmesa_renderer()->render(corner, camera, Pose::Identity(), 0.05, 3);
  StripeBasis basis;
  for (Image<float>& channel : basis.channels) channel = Image<float>(640, 128, 1.0f);
  add_interreflection({exact, camera, Pose::Identity()}, 2, basis);
  const auto along = [&](int v) {  // from the edge, on the plane
    const Eigen::Vector3d p = camera.unproject(320, v, exact.depth(320, v));
    return std::hypot(p.y(), p.z() - 0.66);
  };
  const double H = along(0);
  for (const int v : {8, 24, 40, 87, 103, 119}) {  // middles of patches
    const double x = along(v), expected = 0.5 * (1 - x / std::hypot(x, H));
    EXPECT_NEAR(basis.channels[0](320, v) - 1, expected, 0.15 * expected + 0.01) << v;
  }
}

// ---- the sensor

struct Unit {
  const char* preset;
  double baseline, working_distance, half_field, speckle;
  double stated_sigma;  // m at the working distance (A2)
};

class StructuredLight : public testing::TestWithParam<Unit> {
 protected:
  std::unique_ptr<SensorModel> sensor(const std::string& more = "") const {
    return test::sensor("structured_light", "preset: " + std::string(GetParam().preset) + "\n" + more);
  }
  PinholeCamera camera(int width, int height) const { return test::cropped(sensor()->default_camera(), width, height); }
  double f() const { return sensor()->default_camera().fx; }
  double fB() const { return f() * GetParam().baseline; }

  // Standard deviation in camera pixels of a wall of that albedo at z, in the middle of the image, from the camera's
  // noise: var(phase) = 2 / (N A^2) (mean shot variance + speckle^2 (B^2 + A^2 / 4)), N = 4 samples B + A cos.
  double sigma_px_on_paper(double z, double albedo) const {
    const Unit& unit = GetParam();
    const double well = 52000, read = 10, contrast = 0.9, ambient = 0.1, exposure = 0.75, ratio = 10;
    const double b = unit.baseline, z0 = unit.working_distance, r2 = b * b + z * z;
    const double gain = exposure * well * z0 * z0 * albedo;
    const double white = gain * (z / std::sqrt(r2)) / r2, A = 0.5 * contrast * white;
    const double B = 0.5 * white + ambient * gain;
    const double step = well / 4096;
    const double variance = B + read * read + step * step / 12 + unit.speckle * unit.speckle * (B * B + A * A / 4);
    const double sigma_phase = std::sqrt(2 / (4 * A * A) * variance);
    const double sigma_x = sigma_phase / (2 * kPi * ratio * ratio) * 2 * 1.1 * unit.half_field;
    // From the projector's own tangent to one measured along the camera's axis: the projector is turned in by alpha.
    const double theta = std::atan(b / z), beta = theta - std::atan(b / z0);
    return f() * sigma_x * std::pow(std::cos(beta) / std::cos(theta), 2);
  }
  test::Studio studio_;
};

TEST_P(StructuredLight, NoiseIsWhatTheCameraNoiseImplies) {
  const PinholeCamera small = camera(120, 90);
  for (const double z : {0.5, GetParam().working_distance, 0.9})
    for (const double albedo : {0.6, 0.2}) {
      const Shot shot = studio_.shoot(*sensor(), {{wide_wall(z, {albedo, 0, 0.3})}}, small);
      const double sigma = plane_fit_rms(shot.depth, small, centre_region(small, 0.8));
      const double expected = z * z * sigma_px_on_paper(z, albedo) / fB();  // physical_models A3.5
      EXPECT_NEAR(sigma, expected, 0.2 * expected) << z << ", albedo " << albedo;
    }
}

TEST_P(StructuredLight, StatedNoiseIsThatOfTheDataSheet) {
  const double z = GetParam().working_distance;
  const PinholeCamera small = camera(120, 90);
  EXPECT_NEAR(sensor()->stated_noise(small).sigma(z), GetParam().stated_sigma, 0.01 * GetParam().stated_sigma);
  const Shot shot = studio_.shoot(*sensor(), {{wide_wall(z)}}, small);
  EXPECT_NEAR(plane_fit_rms(shot.depth, small, centre_region(small, 0.8)), GetParam().stated_sigma,
              0.2 * GetParam().stated_sigma);
}

// The whole field at a third of its resolution, on a leaning wall: no pixel falls into another period (at least 3 mm).
TEST_P(StructuredLight, NoPixelTakesAWrongPeriod) {
  PinholeCamera third = sensor()->default_camera();
  third = {
      third.width / 3, third.height / 3, f() / 3, f() / 3, 0.5 * (third.width / 3 - 1), 0.5 * (third.height / 3 - 1)};
  RenderScene scene{{wide_wall(GetParam().working_distance)}};
  scene.items[0].X_WO = scene.items[0].X_WO * pose_from_xyz_rpy({0, 0, 0}, {0.2, 0.25, 0});
  const Shot shot = studio_.shoot(*sensor(), scene, third);
  std::size_t valid = 0;
  for (std::size_t i = 0; i < shot.depth.size(); ++i) {
    if (std::isnan(shot.depth[i])) continue;
    ++valid;
    ASSERT_NEAR(shot.depth[i], shot.exact.depth[i], 1.5e-3) << i;
  }
  EXPECT_GT(valid, shot.depth.size() * 8 / 10);
}

// w = f B (1 / z_near - 1 / z_far) on the left of the foreground, whichever way the projector is turned. Lens blur
// carries light of either side one pixel into it.
TEST_P(StructuredLight, ProjectorShadowHasItsWidth) {
  const PinholeCamera small = camera(320, 60);
  const double near = 0.63, far = 0.65, half = 50 / small.fx * near;
  const RenderScene scene{{wide_wall(far), test::plate(near, {-half, half}, {-2, 2}, 0, {0.6, 0, 0.3})}};
  const double width = fB() * (1 / near - 1 / far);
  const Image<float> sharp = studio_.shoot(*sensor("blur: 0\n"), scene, small).depth;
  EXPECT_NEAR(test::hole_width(sharp, 60, 120), width, 1);  // the plate's outlines lie at 109.5 and 209.5
  EXPECT_LT(test::hole_width(sharp, 200, 260), 1);
  const Image<float> blurred = studio_.shoot(*sensor(), scene, small).depth;
  EXPECT_NEAR(test::hole_width(blurred, 60, 120), width - 1.5, 1.5);
  EXPECT_LT(test::hole_width(blurred, 200, 260), 2);
}

TEST_P(StructuredLight, SteepAndShiningSurfacesLosePoints) {
  const PinholeCamera small = camera(200, 120);
  const double z = GetParam().working_distance;
  const auto fill = [&](const Material& material, double tilt) {
    RenderScene scene{{wide_wall(z, material)}};
    scene.items[0].X_WO = scene.items[0].X_WO * test::place(0, 0, -0.005) * pose_from_xyz_rpy({0, 0, 0}, {tilt, 0, 0}) *
                          test::place(0, 0, 0.005);
    const Shot shot = studio_.shoot(*sensor(), scene, small);
    return fill_rate(shot.depth, centre_region(small, 0.2));
  };
  EXPECT_GT(fill({0.25, 0, 0.3}, 0.5), 0.99);
  EXPECT_LT(fill({0.25, 0, 0.3}, 1.52), 0.1);  // 87 degrees
  // The normal that sends the projector's light into the camera lies half way between them.
  RenderScene mirror{{wide_wall(z, {0.1, 0.8, 0.1})}};
  mirror.items[0].X_WO = mirror.items[0].X_WO * test::place(0, 0, -0.005) *
                         pose_from_xyz_rpy({0, 0, 0}, {0, -0.5 * std::atan(GetParam().baseline / z), 0}) *
                         test::place(0, 0, 0.005);
  const auto seen = [&](const char* more) {
    return fill_rate(studio_.shoot(*sensor(more), mirror, small).depth, centre_region(small, 0.2));
  };
  EXPECT_LT(seen("exposures: 1\n"), 0.05);
  EXPECT_GT(seen("exposures: 4\n"), 0.99);  // a 64th of the light: 20 times a white wall's fits
}

TEST_P(StructuredLight, ThreadsDoNotMatter) {
  const PinholeCamera small = camera(160, 80);
  const RenderScene scene{{wide_wall(0.7), test::plate(0.66, {-0.03, 0.01}, {-0.02, 0.02}, 0, {0.3, 0.4, 0.2})}};
  const auto lit = sensor("interreflection: true\n");
  EXPECT_TRUE(test::same_bits(studio_.shoot(*lit, scene, small, 1).depth, studio_.shoot(*lit, scene, small, 3).depth));
}

// A plane sends itself no light; two planes that face each other do, and most where they meet.
TEST_P(StructuredLight, InterreflectionBendsConcaveCornersOnly) {
  const PinholeCamera small = camera(240, 120);
  const auto lit = sensor("interreflection: true\n");
  const RenderScene wall{{wide_wall(0.65, {0.9, 0, 0.3})}};
  EXPECT_TRUE(test::same_bits(studio_.shoot(*lit, wall, small).depth, studio_.shoot(*sensor(), wall, small).depth));

  RenderScene corner;
  for (const double tilt : {kPi / 4, -kPi / 4}) {
    RenderItem half = test::plate(0, {-1, 1}, {-1, 1}, kIdTable, {0.9, 0, 0.3});
    half.X_WO = test::place(0, 0, 0.66) * pose_from_xyz_rpy({0, 0, 0}, {0, tilt, 0}) * half.X_WO;
    corner.items.push_back(half);
  }
  // Fine stripes average out over the other plane; coarse ones (4 periods at most) do not.
  const auto bend = [&](const std::string& more) {
    const Shot shot = studio_.shoot(*sensor("ratio: 2\nambient: 0\n" + more), corner, small);
    return std::abs(mean_error(shot.depth, shot.exact.depth, {60, 30, 110, 90}));  // left of the edge
  };
  EXPECT_GT(bend("interreflection: true\n"), 5 * bend("") + 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Units, StructuredLight,
                         testing::Values(Unit{"zivid_2", 0.11, 0.7, std::tan(23 * kPi / 180), 0, 0.055e-3},
                                         Unit{"phoxi_m", 0.27, 0.65, std::tan(26.5 * kPi / 180), 0.031, 0.10e-3}),
                         [](const auto& unit) { return std::string(unit.param.preset); });

}  // namespace
}  // namespace binpick

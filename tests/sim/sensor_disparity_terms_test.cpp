// The remaining terms of the stereo model one by one: outlines, jitter, dropouts, holes; then the default preset as a
// whole.
#include "core/primitive.hpp"
#include "sensor_fixtures.hpp"

namespace binpick {
namespace {

using test::bare_disparity;
using test::cropped;

constexpr double kBaseline = 0.0501;  // of d435_848
const PinholeCamera kSmall = cropped(PinholeCamera{}, 170, 96);

TEST(DisparityOutline, ForegroundGrowsByTheStatedPixels) {
  const PinholeCamera camera = cropped(PinholeCamera{}, 200, 10);
  ExactFrame exact = test::wall(camera, 0.6);
  test::add_wall(exact, camera, 0.5, 0, 80, 120);
  for (const int radius : {0, 1, 3}) {
    const auto sensor = bare_disparity("d435_848", "fattening: " + std::to_string(radius) + "\n");
    const Image<float> depth = sensor->capture(exact, camera, Seed{1}, Seed{2});
    for (int u = 0; u < camera.width; ++u) {
      const bool plate = u >= 80 - radius && u < 120 + radius;
      ASSERT_NEAR(depth(u, 5), plate ? 0.5 : 0.6, 1e-3) << radius << " " << u;
    }
    EXPECT_EQ(sensor->stated_noise(PinholeCamera{}).fattening_px, radius);
  }
}

TEST(DisparityOutline, SlopesDoNotGrow) {
  const PinholeCamera camera = cropped(PinholeCamera{}, 200, 10);
  const ExactFrame exact = test::wall(camera, 0.6, 1.1);
  const auto grown = bare_disparity("d435_848", "fattening: 3\n"), plain = bare_disparity("d435_848", "");
  EXPECT_TRUE(test::same_bits(grown->capture(exact, camera, Seed{1}, Seed{2}),
                              plain->capture(exact, camera, Seed{1}, Seed{2})));
}

TEST(DisparityOutline, MixedPixelsLieBetweenAndOnlyThere) {
  const PinholeCamera camera = cropped(PinholeCamera{}, 100, 400);
  ExactFrame exact = test::wall(camera, 0.6);
  test::add_wall(exact, camera, 0.5, 0, 40, 60);
  const auto sensor = bare_disparity("d435_848", "mixed_share: 0.3\n");
  const Image<float> depth = sensor->capture(exact, camera, Seed{1}, Seed{2});
  int mixed = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const bool between = depth(u, v) > 0.502f && depth(u, v) < 0.598f;
      if (between) {
        ASSERT_TRUE(u == 40 || u == 59) << u;
      }
      mixed += between;
    }
  // 800 rim pixels x 0.3, of which the ends of the uniform share fall within 2 mm of either surface (4 %).
  EXPECT_NEAR(mixed, 800 * 0.3 * 0.96, 4 * std::sqrt(800 * 0.3 * 0.7));
}

TEST(DisparityOutline, JitterIsNoiseOnSlopesOnly) {
  const auto sensor = bare_disparity("d435_848", "lateral_jitter: 0.5\ndisparity_step: 0\ndepth_unit: 0\n");
  const ExactFrame frontal = test::wall(kSmall, 0.6);
  for (const float z : sensor->capture(frontal, kSmall, Seed{1}, Seed{2})) ASSERT_NEAR(z, 0.6, 1e-6);
  const double tilt = 0.9;
  const ExactFrame sloped = test::wall(kSmall, 0.6, tilt);
  const Image<float> depth = sensor->capture(sloped, kSmall, Seed{1}, Seed{2});
  double squares = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double e = (kSmall.fx * kBaseline) / depth[i] - (kSmall.fx * kBaseline) / sloped.depth[i];
    squares += e * e;
  }
  // The disparity of a plane has the constant gradient f B tan(tilt) / (f z) per column: jitter sigma times that.
  const double expected = 0.5 * kBaseline * std::tan(tilt) / 0.6;
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(depth.size())), expected, 0.03 * expected);
}

TEST(DisparityDropout, HalfIsLostAtTheCriticalAngle) {
  const PinholeCamera camera = cropped({848, 480, 20000, 20000, 0, 0}, 200, 100);  // narrow: one angle for all pixels
  const double degree = M_PI / 180;
  for (const auto& [angle, lost] : {std::pair{60.0, 0.0067}, {75.0, 0.5}, {81.0, 0.881}}) {
    const auto sensor = bare_disparity("d435_848", "grazing_angle: 75 deg\ngrazing_width: 3 deg\n");
    const Image<float> depth = sensor->capture(test::wall(camera, 1.0, angle * degree), camera, Seed{1}, Seed{2});
    EXPECT_NEAR(1 - test::fill(depth), lost, 0.015 + 0.1 * lost * (1 - lost)) << angle;
  }
}

TEST(DisparityDropout, TooDarkAndTooBrightAreLost) {
  const PinholeCamera camera = cropped(PinholeCamera{}, 40, 40);
  ExactFrame exact = test::wall(camera, 0.6);  // albedo 0.6: return 1.67
  const auto filled = [&](const char* more) {
    return test::fill(bare_disparity("d435_848", more)->capture(exact, camera, Seed{1}, Seed{2}));
  };
  EXPECT_EQ(filled("return_low: 1\n"), 1);
  EXPECT_EQ(filled("return_low: 2\n"), 0);
  EXPECT_EQ(filled("return_high: 1.5\n"), 0);
  EXPECT_EQ(filled("return_high: 3\nlobe: 5\n"), 0);  // seen head on the lobe saturates
  exact = test::wall(camera, 0.6, 0.6);
  EXPECT_EQ(filled("return_high: 3\nlobe: 5\n"), 1);  // turned away it does not
}

TEST(DisparityDropout, SpecklesHaveTheirShare) {
  const auto sensor = bare_disparity("d435_848", "speckle: 0.005\n");
  const ExactFrame exact = test::wall(PinholeCamera{}, 0.7);
  const double n = 848.0 * 480, lost = n * (1 - test::fill(sensor->capture(exact, PinholeCamera{}, Seed{1}, Seed{2})));
  EXPECT_NEAR(lost, 0.005 * n, 4 * std::sqrt(0.005 * n));
}

TEST(DisparityPreset, DefaultFillsAFrontalWall) {
  const PinholeCamera camera;
  const auto sensor = test::sensor("disparity", "");
  const Image<float> depth = sensor->capture(test::wall(camera, 0.6), camera, Seed{1}, Seed{2});
  const int out_of_view = 36;  // f B / 0.6 m = 35.9 columns lie left of the second image
  std::size_t valid = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = out_of_view; u < camera.width; ++u) valid += !std::isnan(depth(u, v));
  EXPECT_NEAR(static_cast<double>(valid) / (480.0 * (848 - out_of_view)), 0.995, 0.002);
  EXPECT_NEAR(sensor->stated_noise(PinholeCamera{}).sigma(0.7), 1.82e-3, 0.01e-3);
}

// A plate lying on a table, through the real renderer and every term of the default preset.
TEST(DisparityPreset, FlatPartHasItsHeightAndItsOutlineGrows) {
  const PinholeCamera camera = cropped(PinholeCamera{}, 240, 160);
  const auto at = [](double z) {
    Pose X = Pose::Identity();
    X.translation().z() = z;
    return X;
  };
  const auto share = [](TriangleMesh mesh) { return std::make_shared<const TriangleMesh>(std::move(mesh)); };
  RenderScene scene;
  scene.items = {{share(mesh_of(Primitive::box({2, 2, 0.01}))), at(0.605), kIdTable, {}},
                 {share(mesh_of(Primitive::box({0.1, 0.06, 0.04}))), at(0.58), 0, {}}};  // its face at 0.56 m
  const ExactFrame exact = make_osmesa_renderer()->render(scene, camera, Pose::Identity(), 0.05, 2);
  const auto sensor = test::sensor("disparity", "", "bias_sigma: 0\n");
  double error = 0, columns = 0;
  int inner = 0;
  const int rows[] = {65, 95};  // well inside the plate's height of 46 px
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Image<float> depth = sensor->capture(exact, camera, Seed{seed}, Seed{100 + seed});
    for (int v = rows[0]; v < rows[1]; ++v)
      for (int u = 0; u < camera.width; ++u) {
        columns += depth(u, v) < 0.575f;
        if (std::abs(u - camera.cx) > 30 || std::isnan(depth(u, v))) continue;
        error += depth(u, v) - 0.56;
        ++inner;
      }
  }
  columns /= 10.0 * (rows[1] - rows[0]);
  // No bias left: the field and the ripple (0.03 px) leave less than 0.05 px on the mean of ten cameras.
  EXPECT_NEAR(error / inner, 0, 0.56 * 0.56 / (430.1 * kBaseline) * 0.05);
  // 76.8 px of plate and 1 px of fattening on either side; jitter and holes move the outline by less than half a pixel.
  EXPECT_NEAR(columns, 430.1 * 0.1 / 0.56 + 2, 1.0);
}

}  // namespace
}  // namespace binpick

// Figures of a heap's depth image where they are known on paper.
#include "sim/heap_quality.hpp"

#include "core/random.hpp"
#include "sensor_fixtures.hpp"

namespace binpick {
namespace {

const PinholeCamera kCamera = test::cropped(PinholeCamera{}, 200, 100);

// A table at 0.6 m (id of the table), a part at 0.4 m in columns 80 .. 139.
ExactFrame table_and_part() {
  ExactFrame exact = test::wall(kCamera, 0.6);
  for (std::int32_t& id : exact.ids) id = kIdTable;
  test::add_wall(exact, kCamera, 0.4, 0, 80, 140);
  return exact;
}

TEST(HeapQuality, AnExactImageHasNoErrorAndNoShadow) {
  const ExactFrame exact = table_and_part();
  const HeapQuality parts = heap_quality(exact.depth, exact, true), rest = heap_quality(exact.depth, exact, false);
  EXPECT_EQ(parts.pixels, 6000u);
  EXPECT_EQ(rest.pixels, 14000u);
  for (const HeapQuality& quality : {parts, rest}) {
    EXPECT_EQ(quality.fill, 1);
    EXPECT_EQ(quality.bias, 0);
    EXPECT_EQ(quality.sigma, 0);
    EXPECT_EQ(quality.gross, 0);
  }
  EXPECT_EQ(shadow_width(exact.depth, exact), 0);
}

TEST(HeapQuality, NoiseBiasHolesAndGrossErrorsAreToldApart) {
  const ExactFrame exact = table_and_part();
  Image<float> depth = exact.depth;
  const Rng rng = Seed{3}.rng();
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 80; u < 140; ++u) {
      Rng draw = rng.at(static_cast<std::uint64_t>(v) * 200 + static_cast<std::uint64_t>(u));
      depth(u, v) += static_cast<float>(0.5e-3 + 1e-3 * draw.normal());
      if (v < 10) depth(u, v) = std::nanf("");      // a tenth
      if (v >= 10 && v < 19) depth(u, v) += 0.05f;  // a tenth of what is left
    }
  const HeapQuality parts = heap_quality(depth, exact, true);
  EXPECT_DOUBLE_EQ(parts.fill, 0.9);
  EXPECT_DOUBLE_EQ(parts.gross, 0.1);
  // The gross tenth moves the median to the 55.6th percentile of the rest: 0.14 sigma; the deviations to the 55.6th of
  // theirs, 0.766 instead of 0.674 sigma. Sampling error of 5400 values: 0.02 sigma.
  EXPECT_NEAR(parts.bias, 0.5e-3 + 0.14e-3, 0.06e-3);
  EXPECT_NEAR(parts.sigma, 1.4826 * 0.766e-3, 0.1e-3);
  EXPECT_NEAR(parts.inverse_depth_noise, parts.sigma / (0.4 * 0.4), 0.05 * parts.sigma / (0.4 * 0.4));
  EXPECT_EQ(heap_quality(depth, exact, false).sigma, 0);
}

TEST(HeapQuality, ShadowIsThatOfTheFormula) {
  const ExactFrame exact = table_and_part();
  const auto sensor = test::bare_disparity("d435_848", "occlusion: true\nfattening: 2\n");
  const Image<float> depth = sensor->capture(exact, kCamera, Seed{1}, Seed{2});
  // The growth of the foreground covers two columns of the shadow.
  EXPECT_NEAR(shadow_width(depth, exact), 430.1 * 0.0501 * (1 / 0.4 - 1 / 0.6) - 2, 1);
}

TEST(HeapQuality, NothingSeenIsNaN) {
  const ExactFrame exact = test::nothing(kCamera);
  const HeapQuality quality = heap_quality(exact.depth, exact, true);
  EXPECT_EQ(quality.pixels, 0u);
  EXPECT_TRUE(std::isnan(quality.fill));
  EXPECT_TRUE(std::isnan(quality.sigma));
  EXPECT_TRUE(std::isnan(shadow_width(exact.depth, exact)));
}

}  // namespace
}  // namespace binpick

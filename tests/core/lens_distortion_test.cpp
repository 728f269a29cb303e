// Brown-Conrady: numbers on paper, the inverse, and lenses that fold.

#include "core/lens_distortion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/random.hpp"

namespace binpick {
namespace {

TEST(LensDistortion, NothingIsThePinhole) {
  const PinholeCamera camera;
  const Eigen::Vector3d p_C(0.11, -0.07, 0.6);
  EXPECT_EQ(project(camera, {}, p_C), camera.project(p_C));
  EXPECT_EQ(ray(camera, {}, 17, 400), camera.ray(17, 400));
}

TEST(LensDistortion, NumbersOnPaper) {
  // At (0.5, 0): m = 1 + 0.25 k1 + 0.0625 k2 + 0.015625 k3.
  EXPECT_DOUBLE_EQ((LensDistortion{-0.2, 0, 0, 0, 0}.distort({0.5, 0}).x()), 0.5 * 0.95);
  EXPECT_DOUBLE_EQ((LensDistortion{0, 0.16, 0, 0, 0}.distort({0.5, 0}).x()), 0.5 * 1.01);
  EXPECT_DOUBLE_EQ((LensDistortion{0, 0, 0, 0, 0.64}.distort({0, 0.5}).y()), 0.5 * 1.01);
  // p1 at (0.3, 0.4): x' += 2 p1 x y = 0.24 p1, y' += p1 (r^2 + 2 y^2) = 0.57 p1; p2 the other way round.
  const Eigen::Vector2d along_y = LensDistortion{0, 0, 0.01, 0, 0}.distort({0.3, 0.4});
  EXPECT_NEAR(along_y.x(), 0.3024, 1e-15);
  EXPECT_NEAR(along_y.y(), 0.4057, 1e-15);
  const Eigen::Vector2d along_x = LensDistortion{0, 0, 0, 0.01, 0}.distort({0.3, 0.4});
  EXPECT_NEAR(along_x.x(), 0.3 + 0.01 * (0.25 + 0.18), 1e-15);
  EXPECT_NEAR(along_x.y(), 0.4024, 1e-15);
}

TEST(LensDistortion, AStraightLineBends) {
  // The line y = 0.24 of the plane z = 1, barrel of -0.1: at x = 0 it is seen at 0.24 (1 - 0.1 * 0.0576), at x = 0.32
  // (r^2 = 0.16) at 0.24 (1 - 0.016): nearer to the axis, by f * (0.236160 - 0.2386176) pixels.
  const PinholeCamera camera{640, 480, 500, 500, 319.5, 239.5};
  const LensDistortion barrel{-0.1, 0, 0, 0, 0};
  const double middle = project(camera, barrel, {0, 0.24, 1}).y(), side = project(camera, barrel, {0.32, 0.24, 1}).y();
  EXPECT_NEAR(middle, 239.5 + 500 * 0.2386176, 1e-9);
  EXPECT_NEAR(side, 239.5 + 500 * 0.23616, 1e-9);
}

TEST(LensDistortion, UndistortIsTheInverse) {
  const PinholeCamera camera;
  const LensDistortion lenses[] = {
      {-0.2, 0.05, 0.001, -0.002, 0}, {0.15, -0.02, 0, 0, 0.001}, {-0.05, 0, 0.01, 0.01, 0}};
  for (const LensDistortion& lens : lenses) {
    ASSERT_NO_THROW(lens.validate(camera));
    Rng rng = Seed{3}.child("test/lens").rng();
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector2d seen = camera.ray(rng.uniform(0, 847), rng.uniform(0, 479)).head<2>();
      EXPECT_LT((lens.distort(lens.undistort(seen)) - seen).norm(), 1e-10);
    }
  }
}

std::string said(const LensDistortion& lens) {
  try {
    lens.validate({640, 480, 500, 500, 319.5, 239.5});
  } catch (const SpecError& error) {
    return error.what();
  }
  return "";
}

TEST(LensDistortion, AFoldIsNamedByItsRadius) {
  // r (1 + k1 r^2) turns back at r = 1 / sqrt(-3 k1), where it has reached 2/3 of r; the corner is seen at 0.8.
  EXPECT_EQ(said({-0.1, 0, 0, 0, 0}), "");            // turns at 1.826, seen at 1.217: outside the image
  const std::string text = said({-0.5, 0, 0, 0, 0});  // turns at 0.8165, seen at 0.5443 = 272 px
  EXPECT_THAT(text, testing::HasSubstr("folds at radius 0.81"));
  EXPECT_THAT(text, testing::HasSubstr("272 px"));
  EXPECT_EQ(said({-0.5, 0.3, 0, 0, 0}), "");  // k2 straightens it: 1 - 1.5 s + 1.5 s^2 has no root
  EXPECT_NE(said({0, 0, 0.2, 0, 0}), "");
  EXPECT_NE(said({0, 0, 0, 0, std::nan("")}), "");
}

}  // namespace
}  // namespace binpick

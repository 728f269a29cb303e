#include "perception/pair_feature.hpp"

#include <gtest/gtest.h>

#include "core/pose.hpp"
#include "core/random.hpp"

namespace binpick {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kAngleError = 1e-4f;  // of the polynomial acos

TEST(PairFeature, OfTwoPointsOnAPlaneIsTheDistanceAndRightAngles) {
  const OrientedPoint a{{0, 0, 0}, {0, 0, 1}}, b{{0.03f, 0.04f, 0}, {0, 0, 1}};
  const PairFeature f = pair_feature(a, b);
  EXPECT_FLOAT_EQ(f.distance, 0.05f);
  EXPECT_NEAR(f.angle_1, kPi / 2, kAngleError);
  EXPECT_NEAR(f.angle_2, kPi / 2, kAngleError);
  EXPECT_NEAR(f.angle_n, 0, kAngleError);
}

TEST(PairFeature, AcrossAPlateSeesOppositeNormals) {
  const OrientedPoint top{{0, 0, 0.01f}, {0, 0, 1}}, bottom{{0, 0, 0}, {0, 0, -1}};
  const PairFeature f = pair_feature(top, bottom);  // d points down
  EXPECT_FLOAT_EQ(f.distance, 0.01f);
  EXPECT_NEAR(f.angle_1, kPi, kAngleError);
  EXPECT_NEAR(f.angle_2, 0, kAngleError);
  EXPECT_NEAR(f.angle_n, kPi, kAngleError);
}

TEST(PairFeature, AtARightAngledEdge) {
  const OrientedPoint a{{0.02f, 0, 0}, {0, 0, 1}}, b{{0, 0, -0.02f}, {-1, 0, 0}};
  const PairFeature f = pair_feature(a, b);
  EXPECT_NEAR(f.angle_1, 3 * kPi / 4, kAngleError);
  EXPECT_NEAR(f.angle_2, kPi / 4, kAngleError);
  EXPECT_NEAR(f.angle_n, kPi / 2, kAngleError);
}

TEST(PairFeature, DoesNotChangeWhenBothPointsMoveRigidly) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Rng rng(seed);
    const auto point = [&] {
      return OrientedPoint{(0.1 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal())).cast<float>(),
                           rng.unit_vector().cast<float>()};
    };
    const OrientedPoint a = point(), b = point();
    const Eigen::Isometry3f X = pose_from(rng.rotation().toRotationMatrix(), rng.unit_vector()).cast<float>();
    const auto moved = [&](const OrientedPoint& p) { return OrientedPoint{X * p.point, X.linear() * p.normal}; };
    const PairFeature f = pair_feature(a, b), g = pair_feature(moved(a), moved(b));
    EXPECT_NEAR(f.distance, g.distance, 1e-6f) << "seed " << seed;
    EXPECT_NEAR(f.angle_1, g.angle_1, 5e-3f) << "seed " << seed;
    EXPECT_NEAR(f.angle_2, g.angle_2, 5e-3f) << "seed " << seed;
    EXPECT_NEAR(f.angle_n, g.angle_n, 5e-3f) << "seed " << seed;
  }
}

TEST(PairFeature, PolynomialAcosStaysCloseToTheLibrarys) {
  for (int i = -1000; i <= 1000; ++i)
    EXPECT_NEAR(unit_angle(static_cast<float>(i) / 1000), std::acos(static_cast<float>(i) / 1000), 1e-4f) << i;
  EXPECT_EQ(unit_angle(1.5f), 0.0f);  // rounding beyond one is not NaN
  EXPECT_FLOAT_EQ(unit_angle(-1.5f), kPi);
}

TEST(PairQuantiser, HasThePapersStepsAndClosedEnds) {
  const PairQuantiser q(0.1, 0.005, 12 * std::numbers::pi / 180);
  EXPECT_EQ(q.angle_bins, 15);     // 180 / 12, no sixteenth bin for exactly pi
  EXPECT_EQ(q.distance_bins, 21);  // 0..5 mm, ..., and 100 mm itself
  EXPECT_EQ(q.angle_bin(0), 0);
  EXPECT_EQ(q.angle_bin(kPi), 14);
  EXPECT_EQ(q.angle_bin(0.999f * q.angle_step), 0);
  EXPECT_EQ(q.angle_bin(1.001f * q.angle_step), 1);
  EXPECT_EQ(q.cell({0.004f, 0, 0, 0}), 0);
  EXPECT_EQ(q.cell({0.006f, 0, 0, 0}), 15 * 15 * 15);
  EXPECT_EQ(q.cell({0.1049f, kPi, kPi, kPi}), q.cells() - 1);
  EXPECT_EQ(q.cell({0.106f, 0, 0, 0}), -1);
}

TEST(Alpha, IsTheTurnAboutTheNormalAndWrapsAround) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Rng rng(seed);
    const Eigen::Vector3f n = rng.unit_vector().cast<float>();
    const Eigen::Matrix3f R = frame_with_x(n);
    EXPECT_LT((R * n - Eigen::Vector3f::UnitX()).norm(), 1e-5f) << "seed " << seed;
    EXPECT_NEAR(R.determinant(), 1.0f, 1e-5f) << "seed " << seed;
    const Eigen::Vector3f d = rng.unit_vector().cast<float>();
    const float turn = static_cast<float>(rng.uniform(0, 2 * std::numbers::pi));
    const Eigen::Vector3f turned = Eigen::AngleAxisf(turn, n) * d;
    const auto difference = static_cast<std::uint16_t>(alpha_turns(R, turned) - alpha_turns(R, d));
    const double error = std::remainder(difference / 65536.0 * 2 * std::numbers::pi - turn, 2 * std::numbers::pi);
    EXPECT_NEAR(error, 0, 1e-3) << "seed " << seed;
  }
}

}  // namespace
}  // namespace binpick

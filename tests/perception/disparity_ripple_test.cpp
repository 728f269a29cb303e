// The wave of a stereo matcher's disparity, read off faces that run through many waves.
#include "perception/disparity_ripple.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.hpp"

namespace binpick {
namespace {

constexpr double kFB = 21.2, kSigma = 0.1;

/// Two walls of 12 and 15 waves, off by a level and a slope of their own.
std::vector<RippleSample> walls(double sine, double cosine, double noise, Seed seed) {
  Rng rng = seed.child("walls").rng();
  std::vector<RippleSample> samples;
  for (int i = 0; i < 4000; ++i) {
    const int face = i % 2;
    const double d = 36 + (face == 0 ? 12 : 15) * rng.uniform(), angle = 2 * std::numbers::pi * d;
    const double off = (face == 0 ? 0.05 : -0.03) + (face == 0 ? 0.002 : -0.004) * d;
    samples.push_back(
        {face, d, off + sine * std::sin(angle) + cosine * std::cos(angle) + noise * rng.normal(), kSigma});
  }
  return samples;
}

TEST(DisparityRipple, IsReadOffWallsThatStandWrong) {
  const DisparityRipple found = fit_ripple(walls(0.03, -0.02, 0, Seed{1}), 2, kFB, 0.05);
  // 4000 samples of 0.1 px, 40 of which share a value, weigh 4000 / 2 / (0.1^2 40) = 5000; the prior 1 / 0.05^2 = 400.
  const double share = 5000.0 / 5400;
  EXPECT_NEAR(found.sine, share * 0.03, 0.0003);
  EXPECT_NEAR(found.cosine, share * -0.02, 0.0003);
}

TEST(DisparityRipple, NoiseAloneIsHardlyAWave) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const DisparityRipple found = fit_ripple(walls(0, 0, kSigma, Seed{seed}), 2, kFB, 0.05);
    // Independent noise: standard deviation kSigma sqrt(2 / 4000) = 0.0022 px of either.
    EXPECT_LT(std::hypot(found.sine, found.cosine), 0.01) << seed;
  }
}

TEST(DisparityRipple, PartsAgainstTheWallDoNotDecide) {
  std::vector<RippleSample> samples = walls(0.03, 0, 0.02, Seed{3});
  for (std::size_t i = 0; i < samples.size(); i += 5) samples[i].off += 1.5;  // nearer than the wall
  const DisparityRipple found = fit_ripple(samples, 2, kFB, 0.05);
  const double share = 4000.0 / 4400;  // a fifth of the samples says nothing
  EXPECT_NEAR(found.sine, share * 0.03, 0.001);
  EXPECT_NEAR(found.cosine, 0, 0.001);
}

TEST(DisparityRipple, ErrorOfTheInverseDepth) {
  const DisparityRipple ripple{kFB, 0.03, 0.01};
  EXPECT_NEAR(ripple.at(kFB / 40.25), 0.03 / kFB, 1e-9);  // a quarter turn: the sine alone
  EXPECT_NEAR(ripple.at(kFB / 41.0), 0.01 / kFB, 1e-9);
  EXPECT_EQ(DisparityRipple{}.at(0.6), 0);
  EXPECT_TRUE(fit_ripple({}, 2, kFB, 0.05).none());
}

}  // namespace
}  // namespace binpick

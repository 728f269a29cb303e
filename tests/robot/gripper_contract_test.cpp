// Every registered gripper: limits finite and not negative, judgement repeatable and free of what must not matter.
#include <gtest/gtest.h>

#include "core/random.hpp"
#include "robot/gripper.hpp"

namespace binpick {
namespace {

class GripperContract : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Registry, GripperContract, testing::ValuesIn(gripper_names()));

/// A wavy plane, sometimes too wavy, sometimes tilted; the same for every draw of the same seed.
std::vector<SurfaceSample> rough(const Gripper& gripper, Rng rng) {
  const double wave = rng.uniform(0, 0.002), tilt = rng.uniform(-0.3, 0.3), gap = rng.uniform(-0.012, 0.002);
  const double turn = rng.uniform(0, 6.28), holes = rng.uniform() < 0.3 ? 0.02 : 0;
  std::vector<SurfaceSample> samples;
  for (const Eigen::Vector3d& p : gripper.probe_points_G()) {
    SurfaceSample sample;
    sample.hit = rng.uniform() >= holes;
    const double along = std::cos(turn) * p.x() + std::sin(turn) * p.y();
    sample.point_G = {p.x(), p.y(), gap + std::tan(tilt) * along + wave * std::sin(300 * p.x())};
    sample.normal_G =
        Eigen::Vector3d(std::tan(tilt) * std::cos(turn), std::tan(tilt) * std::sin(turn), -1).normalized();
    sample.body = 3;
    samples.push_back(sample);
  }
  return samples;
}

TEST_P(GripperContract, LimitsAreFiniteAndNotNegative) {
  const auto gripper = make_gripper(GetParam());
  EXPECT_NO_THROW(gripper->validate());
  EXPECT_EQ(gripper->probe_points_G().size() % gripper->cups().size(), 0u);
  const Rng rng = Seed{11}.child("gripper").rng();
  for (std::uint64_t k = 0; k < 300; ++k) {
    const Contact contact = gripper->judge(rough(*gripper, rng.at(k)));
    EXPECT_EQ(contact.cup_sealed.size(), gripper->cups().size());
    EXPECT_EQ(contact.why.size(), gripper->cups().size());
    for (std::size_t c = 0; c < contact.why.size(); ++c) EXPECT_EQ(contact.cup_sealed[c], contact.why[c].empty());
    for (const double limit :
         {contact.limits.pull, contact.limits.shear, contact.limits.moment, contact.limits.torsion}) {
      EXPECT_TRUE(std::isfinite(limit)) << "draw " << k;
      EXPECT_GE(limit, 0) << "draw " << k;
    }
    if (!contact.sealed) continue;
    EXPECT_GT(contact.limits.pull, 0) << "draw " << k;
  }
}

TEST_P(GripperContract, NothingUnderTheToolNeverSeals) {
  const auto gripper = make_gripper(GetParam());
  const std::vector<SurfaceSample> nothing(gripper->probe_points_G().size());
  const Contact contact = gripper->judge(nothing);
  EXPECT_FALSE(contact.sealed);
  EXPECT_EQ(contact.limits.pull, 0);
}

TEST_P(GripperContract, JudgesTheSameTwiceAndWhateverTheBodysNumber) {
  const auto gripper = make_gripper(GetParam());
  const Rng rng = Seed{11}.child("twice").rng();
  int sealed = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    std::vector<SurfaceSample> samples = rough(*gripper, rng.at(k));
    const Contact first = gripper->judge(samples);
    for (SurfaceSample& sample : samples) sample.body = 17;
    const Contact second = gripper->judge(samples);
    EXPECT_EQ(first.sealed, second.sealed);
    EXPECT_EQ(first.limits.moment, second.limits.moment);
    sealed += first.sealed;
  }
  EXPECT_GT(sealed, 3);
  EXPECT_LT(sealed, 297);
}

TEST_P(GripperContract, BodyStaysBehindTheTip) {
  const auto gripper = make_gripper(GetParam());
  for (const Primitive& body : gripper->body_G())
    for (const Eigen::Vector3d& p_G : mesh_of(body).vertices) EXPECT_LE(p_G.z(), 1e-9);
}

}  // namespace
}  // namespace binpick

// Vacuum holds against the figures known on paper (physical_models B1, V-B1 to V-B3) and the ring of the paper.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "example_parts.hpp"
#include "sim/hold.hpp"
#include "sim/world.hpp"

namespace binpick {
namespace {

constexpr double kGravity = 9.81;

CupSpec cup_of(double diameter, const Eigen::Vector3d& p_GU = Eigen::Vector3d::Zero(), double vacuum = 60e3) {
  CupSpec cup;
  cup.X_GU = Pose(Eigen::Translation3d(p_GU));
  cup.radius = diameter / 2;
  cup.vacuum = vacuum;
  return cup;
}

/// Tool pointing down at height z over the part's top.
Pose tool_at(const Eigen::Vector3d& p_W) {
  return pose_from(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix(), p_W);
}

/// A plate (or any part) on a slab, its top at z = 0, and a tool whose lips press on it.
struct Bench {
  Bench(const Part& part, double top_P, const std::vector<CupSpec>& cups, double dt_, double gravity = kGravity)
      : dt(dt_), world(physics(gravity)) {
    const Primitive slab = Primitive::box({1, 1, 0.1}, Pose(Eigen::Translation3d(0, 0, -0.05)));
    const double height = top_P - bounding_box(part.envelope_P).min().z();
    floor = world.add_fixed({&slab, 1}, Pose(Eigen::Translation3d(0, 0, -height)), {0.4, 0});
    body = world.add_free(part, collision_shape(part), Pose(Eigen::Translation3d(0, 0, -top_P)));
    const Primitive block = Primitive::box({0.02, 0.02, 0.02}, Pose(Eigen::Translation3d(0, 0, -0.05)));
    tool = world.add_moved({&block, 1}, tool_at({0, 0, 0.002}), {0.4, 0});
    hold = std::make_unique<CupHold>(world, tool, cups, HoldConfig{});
  }
  static PhysicsConfig physics(double gravity) {
    PhysicsConfig config;
    config.gravity = gravity;
    return config;
  }
  void step_to(const Eigen::Vector3d& p_W) {
    at = p_W;
    world.move_to(tool, tool_at(p_W));
    hold->step(dt);
  }
  void press_and_seal() {
    for (double z = 0.002; z > -0.001; z -= 0.02 * dt) step_to({0, 0, z});
    for (double t = 0; t < 0.05; t += dt) step_to(at);
    for (std::size_t i = 0; i < hold->cups().size(); ++i) hold->attach(i, body);
    for (double t = 0; t < 0.5; t += dt) step_to(at);
  }
  bool held() const { return hold->holds_any(); }
  /// Moves along `direction` with acceleration(t) until a cup breaks or `duration` is over; returns the acceleration
  /// then.
  double accelerate(const Eigen::Vector3d& direction, const std::function<double(double)>& acceleration,
                    double duration) {
    double speed = 0;
    for (double t = 0; t < duration; t += dt) {
      speed += acceleration(t) * dt;
      step_to(at + speed * dt * direction);
      if (!held()) return acceleration(t - HoldConfig{}.break_time);
    }
    return acceleration(duration);
  }
  double dt;
  World world;
  BodyId floor, body, tool;
  std::unique_ptr<CupHold> hold;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
};

/// 0.1 x 0.1 m plate of a given mass, frame in its middle.
Part plate(double mass, double thickness = 0.01) {
  Part part = example::box({0.1, 0.1, thickness}, mass / (0.01 * thickness));
  for (TriangleMesh* mesh : {&part.envelope_P, &part.mesh_P, &part.pieces_P[0]})
    for (Eigen::Vector3d& v : mesh->vertices) v -= Eigen::Vector3d(0.05, 0.05, thickness / 2);
  return example::finished(part);
}

TEST(Hold, LimitsFollowVacuumTimesArea) {
  const HoldLimits small = cup_of(0.020).limits();
  EXPECT_NEAR(small.pull, 18.85, 0.005);
  EXPECT_NEAR(small.shear, 0.5 * 18.85, 0.005);
  EXPECT_NEAR(small.moment, 18.85 * 0.01, 1e-3);
}

TEST(Hold, VacuumBuildsUpExponentially) {
  Bench bench(plate(0.2), 0.005, {cup_of(0.02)}, 1.0 / 500);
  for (double z = 0.002; z > -0.001; z -= 1e-4) bench.step_to({0, 0, z});
  bench.hold->attach(0, bench.body);
  for (int i = 0; i < 25; ++i) bench.step_to(bench.at);  // 50 ms = one time constant
  EXPECT_NEAR(bench.hold->cups()[0].vacuum_share, 1 - std::exp(-1.0), 1e-9);
  bench.hold->release_all();
  EXPECT_FALSE(bench.held());
}

TEST(Hold, ALeakingCupBuildsUpLessAndHoldsLess) {
  const double mass = 1, share = 0.85, expected = share * 60e3 * std::numbers::pi * 1e-4;
  Bench bench(plate(mass), 0.005, {cup_of(0.02)}, 1.0 / 500);
  for (double z = 0.002; z > -0.001; z -= 0.02 * bench.dt) bench.step_to({0, 0, z});
  bench.hold->attach(0, bench.body, share);
  for (double t = 0; t < 0.5; t += bench.dt) bench.step_to(bench.at);
  EXPECT_NEAR(bench.hold->cups()[0].vacuum_share, share, 1e-4);
  const double a = bench.accelerate(
      {0, 0, 1}, [](double t) { return std::max(0.0, 2.5 * (t - 0.1)); }, 6);
  EXPECT_FALSE(bench.held());
  EXPECT_NEAR(mass * (kGravity + a), expected, 0.02 * expected);
}

TEST(Hold, UseIsTheLoadOverTheLimit) {
  const double mass = 0.1, off = 0.02;  // W / V + W x / (r V), both from paper
  CupSpec cup = cup_of(0.02, {off, 0, 0});
  cup.lip_stiffness = 2e4;
  Bench bench(plate(mass), 0.005, {cup}, 1.0 / 500);
  bench.press_and_seal();
  for (double t = 0; t < 1; t += bench.dt) bench.step_to(bench.at + Eigen::Vector3d(0, 0, 0.1 * bench.dt));
  for (double t = 0; t < 1; t += bench.dt) bench.step_to(bench.at);
  const double full = cup.limits().pull, expected = mass * kGravity / full * (1 + off / cup.radius);
  EXPECT_NEAR(bench.hold->cups()[0].use, expected, 0.02 * expected);
}

TEST(Hold, AFreeLipPressesWithPreloadAndSpring) {
  Bench bench(plate(1), 0.005, {cup_of(0.02)}, 1.0 / 500);
  for (double z = 0.002; z > -0.004; z -= 1e-4) bench.step_to({0, 0, z});
  for (int i = 0; i < 200; ++i) bench.step_to(bench.at);
  const CupSpec cup = cup_of(0.02);
  EXPECT_NEAR(bench.hold->cups()[0].compression, 0.004, 2e-4);
  EXPECT_NEAR(bench.hold->cups()[0].press, cup.preload + cup.stiffness * bench.hold->cups()[0].compression, 0.02);
}

TEST(Hold, StaticReactionsEqualTheWeightAndItsLever) {
  Bench bench(plate(0.5), 0.005, {cup_of(0.03, {0.01, 0, 0})}, 1.0 / 500);
  bench.press_and_seal();
  for (double t = 0; t < 0.5; t += bench.dt) bench.step_to(bench.at + Eigen::Vector3d(0, 0, 0.1 * bench.dt));
  for (double t = 0; t < 1.5; t += bench.dt) bench.step_to(bench.at);
  ASSERT_TRUE(bench.held());
  const CupState& cup = bench.hold->cups()[0];
  const double weight = 0.5 * kGravity;
  const Pose X_WU = bench.hold->X_WU(0);
  const Eigen::Vector3d lever = bench.world.mass_center(bench.body) - X_WU.translation();
  EXPECT_NEAR(std::hypot(cup.pull, cup.shear), weight, 0.002 * weight);
  EXPECT_NEAR(cup.moment, weight * lever.head<2>().norm(), 0.01 * weight * 0.01);
  EXPECT_NEAR(cup.compression, 0, 1e-4);
}

TEST(Hold, FourCupsShareTheLoadByTheLipsGive) {
  // Springs of equal stiffness on a circle R: W_i = W/4 (1 + 2 c.p_i / R^2), c the mass centre seen from the tool's
  // axis. With rigid stops this would be undetermined.
  constexpr double R = 0.03;
  const Eigen::Vector3d off(0.006, 0.003, 0);
  std::vector<CupSpec> cups;
  for (int k = 0; k < 4; ++k)
    cups.push_back(cup_of(
        0.02, off + R * Eigen::Vector3d(std::cos(k * std::numbers::pi / 2), std::sin(k * std::numbers::pi / 2), 0)));
  Bench bench(plate(1), 0.005, cups, 1.0 / 500);
  bench.press_and_seal();
  for (double t = 0; t < 0.5; t += bench.dt) bench.step_to(bench.at + Eigen::Vector3d(0, 0, 0.1 * bench.dt));
  for (double t = 0; t < 2; t += bench.dt) bench.step_to(bench.at);
  const double weight = kGravity;
  for (std::size_t k = 0; k < cups.size(); ++k) {
    ASSERT_TRUE(bench.hold->cups()[k].part.has_value());
    const double share = (1 - 2 * off.dot(cups[k].X_GU.translation() - off) / (R * R)) / 4;
    EXPECT_NEAR(bench.hold->cups()[k].pull, share * weight, 0.02 * weight) << "cup " << k;
  }
}

TEST(Hold, FlatPlateComesOffAtVacuumTimesArea) {  // V-B1
  for (const double vacuum : {60e3, 80e3}) {
    const double mass = 1.5, expected = vacuum * std::numbers::pi * 1e-4;
    Bench bench(plate(mass), 0.005, {cup_of(0.02, {0, 0, 0}, vacuum)}, 1.0 / 500);
    bench.press_and_seal();
    const double a = bench.accelerate(
        {0, 0, 1}, [](double t) { return std::max(0.0, 2.5 * (t - 0.1)); }, 6);
    EXPECT_FALSE(bench.held());
    EXPECT_EQ(bench.hold->cups()[0].broken_by, HoldLimit::kPull);
    EXPECT_NEAR(mass * (kGravity + a), expected, 0.02 * expected) << vacuum;
  }
}

TEST(Hold, PlateSlipsAtFrictionTimesVacuumForce) {  // V-B2, round friction cone
  const double mass = 0.5, expected = 0.5 * 60e3 * std::numbers::pi * 1e-4;
  CupSpec stiff = cup_of(0.02);
  stiff.lip_stiffness = 2e4;  // a lip that hardly bends: shear alone, without the plate swinging under it
  Bench bench(plate(mass, 0.004), 0.002, {stiff}, 1.0 / 500, 0.0);
  bench.press_and_seal();
  for (double t = 0; t < 0.5; t += bench.dt) bench.step_to(bench.at + Eigen::Vector3d(0, 0, 0.1 * bench.dt));
  const double a = bench.accelerate(
      {1, 0, 0}, [](double t) { return 10 * t; }, 4);
  EXPECT_FALSE(bench.held());
  EXPECT_EQ(bench.hold->cups()[0].broken_by, HoldLimit::kShear);
  EXPECT_NEAR(mass * a, expected, 0.03 * expected);
}

TEST(Hold, ALipYieldsSidewaysByForceOverStiffness) {
  const double mass = 0.5, a = 2;
  Bench bench(plate(mass, 0.004), 0.002, {cup_of(0.02)}, 1.0 / 500, 0.0);
  bench.press_and_seal();
  for (double t = 0; t < 0.5; t += bench.dt) bench.step_to(bench.at + Eigen::Vector3d(0, 0, 0.1 * bench.dt));
  bench.accelerate(
      {1, 0, 0}, [&](double t) { return std::min(a, 4 * t); }, 2);
  ASSERT_TRUE(bench.held());
  const double lag = bench.at.x() - bench.hold->X_WU(0).translation().x();
  EXPECT_NEAR(lag, mass * a / HoldConfig{}.lateral_stiffness, 0.05 * lag);
  EXPECT_NEAR(bench.hold->cups()[0].shear, mass * a, 0.01 * mass * a);
}

TEST(Hold, OneKilogramOnA25MillimetreCup) {  // V-B3, at three step lengths
  for (const double dt : {1.0 / 240, 1.0 / 500, 1.0 / 1000}) {
    Bench gentle(plate(1), 0.005, {cup_of(0.025)}, dt);
    gentle.press_and_seal();
    gentle.accelerate(
        {0, 0, 1}, [](double t) { return std::min(5.0, 5 * t); }, 2);
    EXPECT_TRUE(gentle.held()) << dt;
    Bench harsh(plate(1), 0.005, {cup_of(0.025)}, dt);
    harsh.press_and_seal();
    const double a = harsh.accelerate(
        {0, 0, 1}, [](double t) { return 10 * t; }, 4);
    EXPECT_FALSE(harsh.held()) << dt;
    EXPECT_NEAR(a, 60e3 * std::numbers::pi * 0.0125 * 0.0125 - kGravity, 0.03 * 19.64) << dt;
  }
}

TEST(Hold, OneCupOnTheRingsLandPeels) {
  Bench bench(example::ring(), 0.008, {cup_of(0.012, {0.0425, 0, 0})}, 1.0 / 500);
  bench.press_and_seal();
  for (double t = 0; t < 1; t += bench.dt) bench.step_to(bench.at + Eigen::Vector3d(0, 0, 0.05 * bench.dt));
  EXPECT_FALSE(bench.held());
  EXPECT_EQ(bench.hold->cups()[0].broken_by, HoldLimit::kMoment);
}

TEST(Hold, ThreeCupsOnTheRingHoldAtFiveMetresPerSecondSquared) {
  std::vector<CupSpec> cups;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * std::numbers::pi * k / 3;
    cups.push_back(cup_of(0.010, {0.0425 * std::cos(angle), 0.0425 * std::sin(angle), 0}));
  }
  Bench bench(example::ring(), 0.008, cups, 1.0 / 500);
  bench.press_and_seal();
  bench.accelerate(
      {0, 0, 1}, [](double t) { return std::min(5.0, 5 * t); }, 1.5);
  for (const CupState& cup : bench.hold->cups()) EXPECT_TRUE(cup.part.has_value());
  double pull = 0;
  for (const CupState& cup : bench.hold->cups()) pull += cup.pull;
  const double weight = example::ring().mass.mass * (kGravity + 5);
  EXPECT_NEAR(pull, weight, 0.02 * weight);
  for (const CupState& cup : bench.hold->cups()) EXPECT_NEAR(cup.pull, weight / 3, 0.1 * weight / 3);
}

TEST(Hold, AReleasedPartFallsAndTheLipsComeBackOut) {
  Bench bench(plate(0.3), 0.005, {cup_of(0.02)}, 1.0 / 500);
  bench.press_and_seal();
  for (double t = 0; t < 1; t += bench.dt) bench.step_to(bench.at + Eigen::Vector3d(0, 0, 0.1 * bench.dt));
  const double before = bench.world.mass_center(bench.body).z();
  ASSERT_NEAR(before, bench.at.z() - 0.005, 5e-4);
  bench.hold->release_all();
  for (int i = 0; i < 50; ++i) bench.step_to(bench.at);
  EXPECT_LT(bench.world.mass_center(bench.body).z(), before - 0.03);
  EXPECT_NEAR(bench.hold->cups()[0].compression, 0, 1e-4);
  EXPECT_FALSE(bench.hold->cups()[0].broken_by.has_value());
}

}  // namespace
}  // namespace binpick

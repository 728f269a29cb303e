// V-E5: one body and what a textbook says of it. Every value is measured over expected, so that speeds, frictions and
// directions can be drawn; the World's own step rule is used throughout.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/validate/physics_bench.hpp"

namespace binpick {
namespace {

constexpr double kTooLong = 10;  // s, something that should have ended by then did not

/// A flat plate: it slides without tipping up to a friction of 6.
Solid plate(const PhysicsSetting& setting, double friction, double restitution = 0) {
  Solid solid = finished(cuboid_part({0.06, 0.06, 0.01}), setting);
  solid.part.friction = friction;
  solid.part.restitution = restitution;
  return solid;
}

BodyId add_floor(World& world, const Pose& X_WF, double friction, double restitution) {
  const Primitive floor = Primitive::box({20, 20, 1}, Pose(Eigen::Translation3d(0, 0, -0.5)));
  return world.add_fixed({&floor, 1}, X_WF, {friction, restitution});
}

Pose turned_about_z(double angle) { return Pose(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())); }

double slide_over_theory(const PhysicsSetting& setting, double slowest, double fastest, Rng& rng) {
  const double friction = rng.uniform(0.2, 0.6), speed = rng.uniform(slowest, fastest);
  const double heading = rng.uniform(0, 2 * std::numbers::pi), turn = rng.uniform(0, 2 * std::numbers::pi);
  World world(setting.physics);
  add_floor(world, Pose::Identity(), friction, 0);
  const Solid solid = plate(setting, friction);
  const BodyId body =
      world.add_free(solid.part, solid.shape, Pose(Eigen::Translation3d(0, 0, 0.005)) * turned_about_z(turn));
  world.set_velocity(body, speed * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0), Eigen::Vector3d::Zero());
  while (world.awake(body) && world.time() < kTooLong) world.step();
  const double theory = speed * speed / (2 * friction * setting.physics.gravity);
  return world.awake(body) ? std::nan("") : world.mass_center(body).head<2>().norm() / theory;
}

/// How far a plate that is laid on a slope of this angle gets in a second.
double slip(const PhysicsSetting& setting, double friction, double angle, double turn) {
  World world(setting.physics);
  const Pose X_WF(Eigen::AngleAxisd(angle, Eigen::Vector3d(std::cos(turn), std::sin(turn), 0)));
  add_floor(world, X_WF, friction, 0);
  const Solid solid = plate(setting, friction);
  const Pose X_WP = X_WF * Pose(Eigen::Translation3d(0, 0, 0.005));
  const BodyId body = world.add_free(solid.part, solid.shape, X_WP);
  while (world.time() < 1) {
    world.wake(body);
    world.step();
  }
  return (world.mass_center(body) - X_WP.translation()).norm();
}

double incline_over_theory(const PhysicsSetting& setting, Rng& rng) {
  const double friction = rng.uniform(0.2, 0.6), turn = rng.uniform(0, 2 * std::numbers::pi);
  const double theory = std::atan(friction);
  // Slipping at 1.001 of the angle makes 2 mm in the second.
  double low = 0.8 * theory, high = 1.2 * theory;
  for (int i = 0; i < 9; ++i) {
    const double middle = (low + high) / 2;
    (slip(setting, friction, middle, turn) > 0.002 ? high : low) = middle;
  }
  return (low + high) / 2 / theory;
}

/// Height of the first bounce over that of the fall, over e^2.
double bounce_over_theory(const PhysicsSetting& setting, const Solid& solid, double bottom, Rng& rng) {
  const double restitution = rng.uniform(0.3, 0.8), height = rng.uniform(0.2, 0.5);
  World world(setting.physics);
  add_floor(world, Pose::Identity(), 0.4, restitution);
  Part part = solid.part;
  part.restitution = restitution;
  const BodyId body = world.add_free(part, solid.shape, Pose(Eigen::Translation3d(0, 0, height + bottom)));
  const double start = world.mass_center(body).z();
  while (world.velocity(body).z() <= 0 && world.time() < kTooLong) world.step();
  double top = 0;
  while (world.velocity(body).z() > 0 && world.time() < kTooLong) {
    world.step();
    top = std::max(top, world.mass_center(body).z() - start + height);
  }
  return top / height / (restitution * restitution);
}

double fall_over_theory(const PhysicsSetting& setting, Rng& rng) {
  const double height = rng.uniform(0.1, 1);
  World world(setting.physics);
  const Solid solid = ball(0.01, 2700);
  const BodyId body = world.add_free(solid.part, solid.shape, Pose(Eigen::Translation3d(0, 0, height)));
  double before = height, step = 0;
  while (world.mass_center(body).z() > 0 && world.time() < kTooLong) {
    before = world.mass_center(body).z();
    step = world.step();
  }
  const double z = world.mass_center(body).z();
  return (world.time() - step * z / (z - before)) / std::sqrt(2 * height / setting.physics.gravity);
}

/// A ball with its mass centre below its middle rocks on the floor without slipping: a compound pendulum about the
/// contact, T = 2 pi sqrt((I + m (R - d)^2) / (m g d)). World has no hinge; this needs none.
double swing_over_theory(const PhysicsSetting& setting, Rng& rng) {
  constexpr double kSwing = 0.05;  // rad; the period of the linear swing is off by less than 0.05 %
  constexpr int kPeriods = 6;
  const double radius = rng.uniform(0.015, 0.04), off = rng.uniform(0.3, 0.5) * radius;
  PhysicsConfig physics = setting.physics;
  physics.rolling_friction = 0;  // it would stop the swing, as it should
  World world(physics);
  add_floor(world, Pose::Identity(), 0.8, 0);
  Solid solid = ball(radius, 2700, off);
  solid.part.friction = 0.8;
  const Pose tilted(Eigen::AngleAxisd(kSwing, Eigen::Vector3d::UnitY()));
  const BodyId body = world.add_free(
      solid.part, solid.shape,
      turned_about_z(rng.uniform(0, 2 * std::numbers::pi)) * Pose(Eigen::Translation3d(0, 0, radius)) * tilted);
  const Eigen::Vector3d axis = world.pose(body).linear().col(1);
  // It is let go at a turning point; every second zero of the rate about the axis ends a period.
  int turns = 0;
  double rate = 0, ended = std::nan("");
  while (turns < 2 * kPeriods && world.time() < kTooLong) {
    world.wake(body);
    const double step = world.step(), now = world.angular_velocity(body).dot(axis);
    if (rate != 0 && (now > 0) != (rate > 0) && ++turns == 2 * kPeriods)
      ended = world.time() - step * now / (now - rate);
    rate = now;
  }
  const double inertia = 0.4 * radius * radius + (radius - off) * (radius - off);
  const double theory = 2 * std::numbers::pi * std::sqrt(inertia / (setting.physics.gravity * off));
  return ended / kPeriods / theory;
}

}  // namespace

void check_single_body(PhysicsBench& bench) {
  const PhysicsSetting& setting = bench.setting();
  const auto line = [&](const char* what, double tolerance, int full, const std::function<double(Rng&)>& measure) {
    const std::vector<double> ratios =
        bench.each(what, std::max(4, bench.count(full)), [&](Rng& rng, std::size_t) { return measure(rng); });
    const Verdict::Rule rule = tolerance > 0 ? Verdict::Rule::kWithin : Verdict::Rule::kReport;
    Verdict mean = mean_line({"V-E5", std::string(what) + ", over theory", 0, 1, tolerance, "1", rule}, ratios);
    const double error = (mean.high - mean.low) / 4;
    mean.tolerance = widened(tolerance, error, error * std::sqrt(static_cast<double>(ratios.size()) / full));
    bench.add(mean);
  };
  line("distance a plate slides from 1-2 m/s, v^2 / (2 mu g)", 0.02, 200,
       [&](Rng& rng) { return slide_over_theory(setting, 1, 2, rng); });
  line("distance a plate slides from 0.3-1 m/s", 0.02, 200,
       [&](Rng& rng) { return slide_over_theory(setting, 0.3, 1, rng); });
  line("slope on which a plate slips, atan mu", 0.02, 40, [&](Rng& rng) { return incline_over_theory(setting, rng); });
  const Solid round = ball(0.01, 2700), flat = plate(setting, 0.4);
  line("bounce of a ball, e^2 h", 0.02, 200, [&](Rng& rng) { return bounce_over_theory(setting, round, 0.01, rng); });
  // Bullet makes one contact of two hulls per step: what falls flat bounces off one corner first, and spins.
  line("bounce of a plate that falls flat, e^2 h", 0, 200,
       [&](Rng& rng) { return bounce_over_theory(setting, flat, 0.005, rng); });
  line("time of a free fall, sqrt(2 h / g)", 0.01, 200, [&](Rng& rng) { return fall_over_theory(setting, rng); });
  line("period of a rocking ball (compound pendulum)", 0.01, 60,
       [&](Rng& rng) { return swing_over_theory(setting, rng); });
}

}  // namespace binpick

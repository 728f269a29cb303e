// V-B1 to V-B4: pull-off, slip, lift and lever arm of one cup on a plate, against physical_models B1. Every load is
// ramped over at least one second, so that the coupling's springs (damping ratio 0.7) do not overshoot.

#include <cmath>
#include <numbers>

#include "tools/validate/suction_bench.hpp"

namespace binpick {
namespace {

constexpr double kGravity = 9.81;
constexpr double kClear = 0.05;  // m, the part hangs free before the ramp

std::string one_cup(double diameter, double vacuum, const std::string& more = "") {
  return "cups: [{radius: " + std::to_string(diameter / 2) + ", vacuum: " + std::to_string(vacuum) + more + "}]\n";
}

/// The plate hangs on the tool, the vacuum is there. `off`: cup's place on the plate's top.
std::unique_ptr<LiftBench> hanging(const Part& plate, const Gripper& tool, double off, const LiftSetting& setting) {
  const double top = bounding_box(plate.mesh_P).max().z();
  auto bench =
      std::make_unique<LiftBench>(plate, Pose(Eigen::Translation3d(0, 0, -top)), tool, tool_down({off, 0, 0}), setting);
  bench->press();
  bench->seal();
  bench->evacuate();
  bench->raise(kClear);
  bench->wait(0.3);
  bench->forget_peaks();
  return bench;
}

double force_of(double diameter, double vacuum) { return vacuum * std::numbers::pi * diameter * diameter / 4; }

/// Sideways force at which the plate slips; `gravity` pulls at the lip meanwhile.
double slip(double mass, double gravity, double ramp) {
  constexpr double kDiameter = 0.020, kVacuum = 60e3, kFriction = 0.5;
  const Part plate = plate_part(mass, 0.1, 0.004);
  // A lip that hardly bends: shear alone, without the plate swinging under it.
  const auto tool = suction_tool(one_cup(kDiameter, kVacuum, ", lip_stiffness: 20000"));
  LiftSetting setting;
  setting.gravity = gravity;
  const auto bench = hanging(plate, *tool, 0, setting);
  const double expected = kFriction * (force_of(kDiameter, kVacuum) - mass * gravity);
  const double rate = expected / mass / ramp;
  const double a = bench->accelerate(
      {1, 0, 0}, [&](double t) { return std::max(0.0, rate * t); }, 2 * ramp);
  const bool slipped = bench->cups()[0].broken_by == HoldLimit::kShear;
  return slipped ? mass * a : std::nan("");
}

/// The plate of 1 kg on a cup of 25 mm: acceleration at which it drops, or NaN when it did not.
double drop_of_kilogram(double step, double ramp, double top_acceleration) {
  const Part plate = plate_part(1, 0.1, 0.01);
  const auto tool = suction_tool(one_cup(0.025, 60e3));
  LiftSetting setting;
  setting.step = step;
  const auto bench = hanging(plate, *tool, 0, setting);
  const double a = bench->accelerate(
      {0, 0, 1}, [&](double t) { return std::clamp(top_acceleration * t / ramp, 0.0, top_acceleration); }, ramp + 1);
  return bench->holds_all() ? std::nan("") : a;
}

std::string millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%g mm", 1e3 * metres);
  return text;
}

}  // namespace

PullOff measure_pull_off(double diameter, double vacuum, double mass, double ramp) {
  const Part plate = plate_part(mass, 0.1, 0.01);
  const auto tool = suction_tool(one_cup(diameter, vacuum));
  const auto bench = hanging(plate, *tool, 0, {});
  const double rate = (force_of(diameter, vacuum) / mass - kGravity) / ramp;
  const double a = bench->accelerate(
      {0, 0, 1}, [&](double t) { return std::max(0.0, rate * t); }, 2 * ramp);
  if (bench->holds_all()) return {std::nan(""), std::nan("")};
  return {mass * (kGravity + a), bench->peaks().pull};
}

double measure_peel(double off, double mass, double ramp) {
  constexpr double kDiameter = 0.020, kVacuum = 60e3;
  const Part plate = plate_part(mass, 0.12, 0.004);
  const auto tool = suction_tool(one_cup(kDiameter, kVacuum, ", lip_stiffness: 20000"));
  const auto bench = hanging(plate, *tool, off, {});
  const double load = force_of(kDiameter, kVacuum) / (1 + 2 * off / kDiameter);
  const double rate = (load / mass - kGravity) / ramp;
  const double a = bench->accelerate(
      {0, 0, 1}, [&](double t) { return std::max(0.0, rate * t); }, 2 * ramp);
  return bench->holds_all() ? std::nan("") : mass * (kGravity + a);
}

void check_pull_off(SuctionBench& bench) {
  for (const double vacuum : {60e3, 80e3}) {
    const double expected = force_of(0.020, vacuum);
    const std::string what = "20 mm cup, " + std::to_string(static_cast<int>(vacuum / 1e3)) + " kPa, plate: pull-off";
    std::vector<double> loads, readings;
    bench.each("pull-off", [&](Rng& rng) {
      const double mass = rng.uniform(0.6, 1.6), ramp = rng.uniform(1.0, 2.0);
      const PullOff off = measure_pull_off(0.020, vacuum, mass, ramp);
      loads.push_back(off.load);
      readings.push_back(off.reading);
      return off.load;
    });
    bench.mean_line({"V-B1", what + ", m (g + a)", 0, expected, 0.02 * expected, "N"}, loads);
    bench.mean_line({"V-B1", what + ", the coupling's reading", 0, expected, 0.02 * expected, "N"}, readings);
  }
}

void check_slip(SuctionBench& bench) {
  const double coulomb = 0.5 * force_of(0.020, 60e3);
  const auto weightless = bench.each("slip", [](Rng& rng) {
    const double mass = rng.uniform(0.3, 0.8);
    return slip(mass, 0, rng.uniform(1.0, 2.0));
  });
  bench.mean_line(
      {"V-B2", "20 mm cup, mu 0.5, plate without weight: slip (round Coulomb cone)", 0, coulomb, 0.02 * coulomb, "N"},
      weightless);
  // The weight takes its share of the force that keeps the lip on: mu (V - W).
  const auto share = bench.each("slip with weight", [&](Rng& rng) {
    const double mass = rng.uniform(0.3, 0.8), expected = coulomb - 0.5 * mass * kGravity;
    return slip(mass, kGravity, rng.uniform(1.0, 2.0)) / expected;
  });
  bench.mean_line({"V-B2", "the same, hanging: slip over mu (V - W)", 0, 1, 0.03, "1"}, share);
}

void check_lift(SuctionBench& bench) {
  const double expected = force_of(0.025, 60e3) - kGravity;  // for 1 kg
  for (const double step : {1.0 / 240, 1.0 / 1000}) {
    const std::string what = "1 kg, 25 mm cup, step 1/" + std::to_string(std::lround(1 / step)) + " s: ";
    std::size_t held = 0;
    const auto gentle = bench.each("lift at 5", [&](Rng& rng) { return drop_of_kilogram(step, rng.uniform(1, 2), 5); });
    for (const double a : gentle) held += std::isnan(a) ? 1 : 0;
    bench.share_line({"V-B3", what + "share held at 5 m/s^2", 0, 1, 0, "1"}, held, gentle.size());
    const auto harsh =
        bench.each("lift off", [&](Rng& rng) { return drop_of_kilogram(step, 2 * rng.uniform(1, 2), 2 * expected); });
    bench.mean_line({"V-B3", what + "drops at", 0, expected, 0.03 * expected, "m/s^2"}, harsh);
  }
}

void check_lever_arm(SuctionBench& bench) {
  constexpr double kRadius = 0.010;
  const double k_limit = 15.6 * kRadius * std::numbers::pi;  // N m/kg, SuctionNet's wrench score (physical_models B1)
  for (const double off : {0.0, 0.0125, 0.025, 0.040}) {
    const auto scores = bench.each("lever arm", [&](Rng& rng) {
      const double mass = rng.uniform(0.02, 0.06);  // light, so that the lip hardly bends
      const Part plate = plate_part(mass, 0.12, 0.004);
      const auto tool = suction_tool(one_cup(2 * kRadius, 60e3));
      const auto hung = hanging(plate, *tool, off, {});
      hung->wait(0.7);
      const CupState& cup = hung->cups()[0];
      return cup.part ? 1 - std::min(cup.moment / mass / k_limit, 1.0) : std::nan("");
    });
    bench.mean_line({"V-B4", "plate held " + millimetres(off) + " off its middle: score from the coupling's moment", 0,
                     1 - off / 0.050, 0.02, "1"},
                    scores);
  }
  // Peel: m (g + a) x = (V - m (g + a)) r.
  const double force = force_of(2 * kRadius, 60e3);
  for (const double off : {0.010, 0.025}) {
    const double expected = force * kRadius / (off + kRadius);
    const auto loads = bench.each("peel", [&](Rng& rng) {
      const double mass = rng.uniform(0.1, 0.3);
      return measure_peel(off, mass, rng.uniform(1.0, 2.0));
    });
    bench.mean_line(
        {"V-B4", "20 mm cup " + millimetres(off) + " off: load that peels it", 0, expected, 0.03 * expected, "N"},
        loads);
  }
}

}  // namespace binpick

// V-E1 to V-E3: on which face single solids come to rest. Quasi-static theory: the share of directions in which the
// face is seen from the mass centre. Dice: real steel cuboids (Budden's throws, Math. Gazette 97.16), physical_models
// E2.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/validate/physics_bench.hpp"

namespace binpick {
namespace {

constexpr double kSize = 0.02;  // m, cylinders' diameter and edge of the cube with a cuboid's volume
constexpr int kLaidDown = 3000, kThrown = 800;

std::string number(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// How many rest with this axis of P nearer to the vertical than to the floor (an eighth of a turn divides them).
std::size_t upright(const std::vector<Rest>& rests, int axis) {
  return static_cast<std::size_t>(std::count_if(rests.begin(), rests.end(), [&](const Rest& rest) {
    return std::abs(rest.X_WP.linear()(2, axis)) > std::numbers::sqrt2 / 2;
  }));
}

/// Square ends of edge y, length x, with the volume of the cube of kSize.
Solid cuboid_of(double ratio, const PhysicsSetting& setting) {
  const double y = kSize / std::cbrt(ratio);
  return finished(cuboid_part({ratio * y, y, y}), setting);
}

double quasi_static(double ratio) { return 2 / std::numbers::pi * std::asin(1 / (1 + ratio * ratio)); }

/// `tolerance` of the full form, widened by what fewer throws leave open.
void add_share(PhysicsBench& bench, Verdict line, std::size_t hits, int total, int full) {
  line.tolerance = widened(line.tolerance, share_error(line.expected, total), share_error(line.expected, full));
  bench.add(share_line(line, hits, static_cast<std::size_t>(total)));
}

/// Students' throws of cuboids: x / y, share on the square ends, number of throws.
struct Dice {
  double ratio, observed;
  int throws;
};
constexpr Dice kDice[] = {{0.47, .916, 332}, {0.63, .738, 840}, {0.75, .548, 799},  {0.81, .496, 740},
                          {0.93, .399, 516}, {0.97, .385, 530}, {1.16, .148, 1011}, {1.23, .154, 532},
                          {1.44, .052, 654}, {1.55, .040, 606}, {1.60, .017, 702},  {1.71, .031, 609},
                          {1.87, .009, 680}, {2.12, .007, 275}, {2.65, .006, 503}};

}  // namespace

void check_cylinders(PhysicsBench& bench) {
  const int total = bench.count(kLaidDown);
  for (const double eta : {0.25, 0.354, 0.5}) {
    const Solid solid = finished(cylinder_part(kSize, eta * kSize), bench.setting());
    const std::string what = "cylinder h/D " + number("%.3g", eta) + " laid down: P(side)";
    const std::vector<Rest> rests = bench.throws(what.c_str(), total, solid, laid_down(bench.setting().physics));
    bench.note(rests);
    const double expected = eta / std::sqrt(1 + eta * eta);
    add_share(bench, {"V-E1", what, 0, expected, 0.05, "1"}, rests.size() - upright(rests, 2), total, kLaidDown);
  }
}

void check_cuboids(PhysicsBench& bench) {
  const int total = bench.count(kLaidDown);
  for (const double ratio : {0.47, 1.44}) {
    const std::string what = "cuboid x/y " + number("%.3g", ratio) + " laid down: P(square end)";
    const std::vector<Rest> rests =
        bench.throws(what.c_str(), total, cuboid_of(ratio, bench.setting()), laid_down(bench.setting().physics));
    bench.note(rests);
    add_share(bench, {"V-E2", what, 0, quasi_static(ratio), 0.04, "1"}, upright(rests, 0), total, kLaidDown);
  }
}

void check_thrown_cuboids(PhysicsBench& bench) {
  const int total = bench.count(kThrown);
  const ThrowSetting setting = thrown(bench.setting().physics);
  double last = 1, last_error = 0, largest_rise = -1, rise_error = 0;
  for (const Dice& dice : kDice) {
    const std::string what = "cuboid x/y " + number("%.2f", dice.ratio) + " thrown: P(square end)";
    const std::vector<Rest> rests = bench.throws(what.c_str(), total, cuboid_of(dice.ratio, bench.setting()), setting);
    bench.note(rests);
    const double theory = quasi_static(dice.ratio), p = static_cast<double>(upright(rests, 0)) / total;
    // Of the rows and of these throws; a share of none is as uncertain as one of one.
    const double error = std::hypot(share_error(std::max(p, 1.0 / total), total),
                                    share_error(std::max(dice.observed, 1.0 / dice.throws), dice.throws));
    bench.add(share_line({"V-E3", what + ", between theory and dice", 0, (theory + dice.observed) / 2,
                          std::abs(theory - dice.observed) / 2 + 3 * error, "1"},
                         upright(rests, 0), rests.size()));
    const double own_error = share_error(std::max(p, 1.0 / total), total);
    if (p - last - 3 * std::hypot(own_error, last_error) > largest_rise - 3 * rise_error)
      largest_rise = p - last, rise_error = std::hypot(own_error, last_error);
    last = p, last_error = own_error;
  }
  bench.add({"V-E3", "thrown cuboids: largest rise of P with x/y", largest_rise, 0, 3 * rise_error, "1",
             Verdict::Rule::kBelow});
  const Solid cube = finished(cuboid_part({kSize, kSize, kSize}), bench.setting());
  const std::vector<Rest> rests = bench.throws("cube", 3 * total, cube, setting);
  bench.note(rests);
  for (int axis = 0; axis < 3; ++axis)
    bench.add(share_line({"V-E3", std::string("cube thrown: P(") + "xyz"[axis] + " upright)", 0, 1.0 / 3,
                          3 * share_error(1.0 / 3, 3 * total), "1"},
                         upright(rests, axis), rests.size()));
}

}  // namespace binpick

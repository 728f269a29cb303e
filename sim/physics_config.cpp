// Reading and checking of the settings of world, drop and settle.
#include "core/error.hpp"
#include "sim/drop.hpp"
#include "sim/world.hpp"

namespace binpick {
namespace {

void require(bool condition, const char* message) {
  if (!condition) throw SpecError(message);
}

}  // namespace

void PhysicsConfig::visit(ConfigVisitor& v) {
  v.field("gravity", gravity, Unit::kAcceleration, "acceleration of free fall, along -z of the world");
  v.field("fine_step", fine_step, Unit::kTime, "step while any awake part is fast");
  v.field("coarse_step", coarse_step, Unit::kTime, "step while no awake part is fast");
  v.field("fast_speed", fast_speed, Unit::kSpeed, "|v| + |w| R above which a part is fast");
  v.field("fine_iterations", fine_iterations, "iterations of the contact solver in a fine step");
  v.field("coarse_iterations", coarse_iterations, "iterations of the contact solver in a coarse step");
  v.field("iterations", iterations, "iterations of the contact solver in lockstep with the arm");
  v.field("margin", margin, Unit::kLength, "collision margin; faces are inset by it, so only edges are rounded");
  v.field("contact_threshold", contact_threshold, Unit::kLength,
          "distance at which contacts are made ahead of touching");
  v.field("rolling_friction", rolling_friction, Unit::kLength, "lever arm of rolling and spinning friction of parts");
  v.field("freeze_far", freeze_far, "parts that nothing has moved are frozen while the arm works");
  v.field("wake_weights", wake_weights, Unit::kNone, "a frozen part wakes at so many weights of contact force above that at rest");
  v.field("wake_motion", wake_motion, Unit::kLength, "a frozen part wakes when one that touches it has moved more");
}

void PhysicsConfig::validate() const {
  require(gravity >= 0 && gravity <= 100, "physics.gravity: must lie between 0 and 100 m/s^2");
  require(fine_step >= 1e-5 && fine_step <= coarse_step, "physics.fine_step: must lie between 0.01 ms and coarse_step");
  require(coarse_step <= 1.0 / 60, "physics.coarse_step: must be at most 1/60 s");
  require(fast_speed > 0, "physics.fast_speed: must be above 0");
  require(fine_iterations >= 1 && fine_iterations <= 1000, "physics.fine_iterations: must lie between 1 and 1000");
  require(coarse_iterations >= 1 && coarse_iterations <= 1000, "physics.coarse_iterations: must lie between 1 and 1000");
  require(iterations >= 1 && iterations <= 1000, "physics.iterations: must lie between 1 and 1000");
  require(margin >= 1e-5 && margin <= 2e-3,
          "physics.margin: must lie between 0.01 and 2 mm (a zero margin never rests)");
  require(contact_threshold >= margin && contact_threshold <= 0.02,
          "physics.contact_threshold: must lie between the margin and 20 mm");
  require(wake_weights > 0 && wake_weights <= 100, "physics.wake_weights: must lie between 0 and 100");
  require(wake_motion > 0 && wake_motion <= 2e-3, "physics.wake_motion: must lie between 0 and 2 mm");
  require(rolling_friction >= 0 && rolling_friction <= 0.01, "physics.rolling_friction: must lie between 0 and 10 mm");
}

void DropConfig::visit(ConfigVisitor& v) {
  v.choice("kind", kind, {"rain", "dump", "shaken"},
           "rain: parts fall one by one; dump: together, out of a tote; shaken: rain, then the bin vibrates");
  v.field("fill", fill, Unit::kNone,
          "share of the bin's volume that the parts' own volume makes, the counts say the mix; 0: the counts are numbers");
  v.field("height", height, Unit::kLength, "fall of the part's lowest possible point to heap or floor");
  v.field("interval", interval, Unit::kTime, "time between parts");
  v.field("area", area, Unit::kNone, "share of the bin's length and width in which parts are released");
  v.field("speed", speed, Unit::kSpeed, "largest random initial speed");
  v.field("spin", spin, Unit::kAngularSpeed, "largest random initial spin");
  v.section("dump", dump, "kind dump: the tote over the bin");
  v.section("shake", shake, "kind shaken: the vibrating table");
}

void DropConfig::validate() const {
  require(fill >= 0 && fill <= 0.5, "drop.fill: must lie between 0 and 0.5 (parts poured without order fill no more)");
  require(height >= 0 && height <= 5, "drop.height: must lie between 0 and 5 m");
  require(interval >= 0 && interval <= 60, "drop.interval: must lie between 0 and 60 s");
  require(area >= 0 && area <= 1, "drop.area: must lie between 0 and 1");
  require(speed >= 0 && speed <= 5, "drop.speed: must lie between 0 and 5 m/s");
  require(spin >= 0 && spin <= 200, "drop.spin: must lie between 0 and 200 rad/s");
  dump.validate();
  shake.validate();
}

void SettleConfig::visit(ConfigVisitor& v) {
  v.field("time_limit", time_limit, Unit::kTime, "simulated time after the last part until a heap counts as unsettled");
  v.field("motion", motion, Unit::kLength, "largest displacement (and R x rotation) of a part at rest, in two windows");
  v.field("window", window, Unit::kTime, "length of the two windows");
  v.field("max_penetration", max_penetration, Unit::kLength, "a deeper contact at rest rejects the heap");
  v.field("wake_time", wake_time, Unit::kTime, "so long the heap at rest is kept awake and watched; 0: it is believed");
  v.field("wake_motion", wake_motion, Unit::kLength, "a part that moves more in that time rejects the heap");
}

void SettleConfig::validate() const {
  require(time_limit > 0 && time_limit <= 600, "settle.time_limit: must lie between 0 and 600 s");
  require(motion > 0 && motion <= 0.01, "settle.motion: must lie between 0 and 10 mm");
  require(window >= 0.05 && window <= 5, "settle.window: must lie between 50 ms and 5 s");
  require(wake_time >= 0 && wake_time <= 60, "settle.wake_time: must lie between 0 and 60 s");
  require(wake_motion > 0 && wake_motion <= 0.1, "settle.wake_motion: must lie between 0 and 100 mm");
  require(max_penetration > 0 && max_penetration <= 0.05, "settle.max_penetration: must lie between 0 and 50 mm");
}

}  // namespace binpick

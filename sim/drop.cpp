#include "sim/drop.hpp"

#include <algorithm>
#include <cmath>

#include "sim/bin.hpp"
#include "sim/drop_stages.hpp"
#include "sim/settle.hpp"

namespace binpick {
namespace {

constexpr double kFalling = 0.5;         // m/s: a faster part is still on its way and not part of the heap
constexpr double kSimulatedFall = 0.02;  // m, the last of it; before, parts of a stream meet nothing
constexpr double kSpawnGap = 1e-3;       // m between bounding spheres of a new part and the parts on their way
constexpr double kLongestWait = 3.0;     // s, for the way to be clear

/// One drop: everything that stays the same from part to part.
class Dropper {
 public:
  Dropper(World& world, const BinSpec& bin, const Pose& X_WB, const DropConfig& config)
      : world_(world), bin_(bin), X_WB_(X_WB), config_(config) {}

  BodyId release(const DropItem& item, Rng rng) {
    const BodyId body = world_.add_free(*item.part, *item.shape, Pose::Identity());
    const double radius = world_.bounding_radius(body);
    world_.set_present(body, false);
    const double x = rng.uniform(-1, 1) * reach(bin_.inner_size.x(), radius);
    const double y = rng.uniform(-1, 1) * reach(bin_.inner_size.y(), radius);
    const Eigen::Matrix3d R_WP = rng.rotation().toRotationMatrix();
    const Eigen::Vector3d spin = rng.unit_vector() * rng.uniform() * config_.spin;
    const Eigen::Vector3d speed = rng.unit_vector() * rng.uniform() * config_.speed;
    const Eigen::Vector3d centre_W = clear_centre({x, y, 0}, radius);
    const Eigen::Vector3d fallen_W(0, 0, -std::sqrt(2 * world_.gravity() * (config_.height - simulated_fall())));
    const Eigen::Vector3d p_PM_W = R_WP * item.part->mass.center_P;
    world_.teleport(body, pose_from(R_WP, centre_W - p_PM_W));
    world_.set_velocity(body, speed + fallen_W, spin);
    world_.set_present(body, true);
    world_.wake(body);
    bodies_.push_back(body);
    landed_.push_back(false);
    return body;
  }

  void wait(double duration) {
    for (const double end = world_.time() + duration; world_.time() < end;) world_.step();
  }

 private:
  /// Half the width in which a mass centre may be released: never nearer to a wall than the bounding radius.
  double reach(double width, double radius) const {
    return std::max(0.0, std::min(config_.area * width / 2, width / 2 - radius));
  }

  double height_in_bin(const Eigen::Vector3d& p_W) const { return (X_WB_.inverse() * p_W).z(); }

  /// Where the mass centre shall be: above what lies, and clear of what still falls (after waiting for it).
  Eigen::Vector3d clear_centre(const Eigen::Vector3d& p_B, double radius) {
    const double start = world_.time();
    double lift = 0;
    while (true) {
      const double height = heap_top() + simulated_fall() + radius + lift;
      const Eigen::Vector3d centre_W = X_WB_ * Eigen::Vector3d(p_B.x(), p_B.y(), height);
      if (is_clear(centre_W, radius)) return centre_W;
      if (world_.time() - start > kLongestWait)
        lift += radius;
      else
        world_.step();
    }
  }

  double simulated_fall() const { return std::min(config_.height, kSimulatedFall); }

  /// Height of what lies. A slow part in mid-air has only just been released: on it the next would stand as on a tower.
  double heap_top() {
    double top = 0;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const bool slow = world_.velocity(bodies_[k]).norm() < kFalling;
      landed_[k] = landed_[k] || (slow && !world_.contacts(bodies_[k]).empty());
      if (!landed_[k] || !slow) continue;
      top = std::max(top, height_in_bin(world_.mass_center(bodies_[k])) + world_.bounding_radius(bodies_[k]));
    }
    return top;
  }

  bool is_clear(const Eigen::Vector3d& centre_W, double radius) const {
    return std::all_of(bodies_.begin(), bodies_.end(), [&](BodyId other) {
      const double distance = (world_.mass_center(other) - centre_W).norm();
      return distance > radius + world_.bounding_radius(other) + kSpawnGap;
    });
  }

  World& world_;
  const BinSpec& bin_;
  const Pose& X_WB_;
  const DropConfig& config_;
  std::vector<BodyId> bodies_;
  std::vector<bool> landed_;  ///< of each: it has met something
};

/// Parts that leaned on the guard walls fall when these go away: they are woken and the heap settles again.
void remove_guard(World& world, BodyId guard, const DropResult& result, double rim, const Pose& X_WB) {
  for (const BodyId body : result.bodies) {
    const double top = (X_WB.inverse() * world.mass_center(body)).z() + world.bounding_radius(body);
    if (top > rim && world.present(body)) world.wake(body);
  }
  world.set_present(guard, false);
}

}  // namespace

double guard_top(std::span<const DropItem> items, const BinSpec& box, const DropConfig& drop) {
  double stack = box.inner_size.z() + drop.height + 0.5;
  for (const DropItem& item : items) stack += item.part->diameter;
  return stack;
}

std::vector<BodyId> rain_parts(World& world, std::span<const DropItem> items, const BinSpec& box, const Pose& X_WB,
                               const DropConfig& drop, Seed seed) {
  std::vector<BodyId> bodies;
  Dropper dropper(world, box, X_WB, drop);
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (k > 0) dropper.wait(drop.interval);
    bodies.push_back(dropper.release(items[k], seed.child("part", k).rng()));
  }
  return bodies;
}

DropResult drop_parts(World& world, std::span<const DropItem> items, const BinSpec& bin, const Pose& X_WB,
                      const DropConfig& drop, const SettleConfig& settle_config, Seed seed) {
  DropResult result;
  const bool dump = drop.kind == "dump";
  const BodyId guard =
      add_guard_walls(world, bin, X_WB, dump ? dump_top(items, bin, drop) : guard_top(items, bin, drop));
  result.bodies = (dump ? dump_parts : rain_parts)(world, items, bin, X_WB, drop, seed);
  for (const DropItem& item : items) result.parts.push_back(item.part_index);
  if (drop.kind == "shaken") {
    settle_report(world, settle_config);
    shake(world, drop.shake, seed.child("shake"));
  }
  const SettleReport first = settle_report(world, settle_config);
  remove_guard(world, guard, result, bin.inner_size.z(), X_WB);
  SettleConfig rest = settle_config;
  rest.time_limit = std::max(settle_config.time_limit - first.time, 0.5);
  const SettleReport second = settle_report(world, rest);
  result.settle_time = first.time + second.time;
  result.damped = first.damped || second.damped;
  result.worst_penetration = world.deepest_contact();
  if (!first.at_rest || !second.at_rest)
    result.unsettled = "the heap was not at rest within the time limit";
  else if (result.worst_penetration > settle_config.max_penetration)
    result.unsettled = "parts penetrate each other";
  result.settled = result.unsettled.empty();
  for (const DropItem& item : items) result.diameters.push_back(item.part->diameter);
  result.escaped = escaped(world, bin, X_WB, result);
  return result;
}

std::vector<std::size_t> escaped(const World& world, const BinSpec& bin, const Pose& X_WB, const DropResult& drop) {
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < drop.bodies.size(); ++k)
    if (!inside_bin(bin, X_WB, world.mass_center(drop.bodies[k]), drop.diameters[k])) indices.push_back(k);
  return indices;
}

}  // namespace binpick

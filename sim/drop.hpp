// How parts enter the bin, and when the heap is at rest.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/bin_spec.hpp"
#include "core/config.hpp"
#include "core/random.hpp"
#include "sim/drop_kinds.hpp"
#include "sim/world.hpp"

namespace binpick {

struct DropConfig {
  std::string kind = "rain";  ///< rain: one by one; dump: together, out of a tote; shaken: rain, then a vibrating table
  double fill = 0;         ///< share of the bin's volume that the parts' own volume makes; 0: as many as `count` says
  double height = 0.30;    ///< m, that the part's lowest possible point falls to the highest part or the floor
  double interval = 0.05;  ///< s between parts
  double area = 0.8;       ///< share of the bin's length and width in which parts are released
  double speed = 0.0;      ///< m/s, largest random initial speed
  double spin = 2.0;       ///< rad/s, largest random initial spin
  DumpConfig dump;
  ShakeConfig shake;
  void visit(ConfigVisitor& v);
  void validate() const;
};

struct SettleConfig {
  double time_limit = 12.0;       ///< s simulated after the last part
  double motion = 1e-4;           ///< m (and m of R x rotation): largest displacement in two windows at rest
  double window = 0.25;           ///< s
  double max_penetration = 1e-3;  ///< m: a deeper contact at rest rejects the heap
  double wake_time = 2.0;         ///< s: so long the heap at rest is kept awake, and watched; 0: it is believed
  double wake_motion = 1e-3;      ///< m (and m of R x rotation): a part that moves more then rejects the heap
  void visit(ConfigVisitor& v);
  void validate() const;
};

/// What parts did that were kept awake. Motion: of the mass centre, or R x rotation where that is more.
struct WakeReport {
  double energy = 0;          ///< J, largest kinetic energy of a part at the end
  double largest_motion = 0;  ///< m, from the first to the last moment
  double moved_share = 0;     ///< of the parts, those that moved by more than 0.1 mm
};

struct DropResult {
  std::vector<BodyId> bodies;      ///< in order of release; index = heap index
  std::vector<std::size_t> parts;  ///< which part each is
  std::vector<double> diameters;   ///< m, of each
  bool settled = false;
  double settle_time = 0;            ///< s after the last release
  std::vector<std::size_t> escaped;  ///< heap indices whose mass centre is outside the bin at rest
  double worst_penetration = 0;      ///< m, deepest contact of what collides
  bool damped = false;               ///< late damping acted
  std::string unsettled;             ///< why the heap is not settled; empty when it is
  // What check_rest() (rest_check.hpp) finds; empty before.
  WakeReport woken;
  std::vector<double> penetrations;  ///< m, of true solids
};

struct DropItem {
  const Part* part = nullptr;
  const CollisionShape* shape = nullptr;
  std::size_t part_index = 0;
};

/// The invisible tall walls that keep falling parts above the bin go away before this returns.
DropResult drop_parts(World& world, std::span<const DropItem> items, const BinSpec& bin, const Pose& X_WB,
                      const DropConfig& drop, const SettleConfig& settle, Seed seed);

/// Heap indices of the bodies whose mass centre is outside the bin.
std::vector<std::size_t> escaped(const World& world, const BinSpec& bin, const Pose& X_WB, const DropResult& drop);

/// Steps until every free body is at rest or the time limit is reached; returns whether at rest.
bool settle(World& world, const SettleConfig& config, double* time_used = nullptr);

}  // namespace binpick

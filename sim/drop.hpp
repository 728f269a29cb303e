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
  double height = 0.30;       ///< m, release height of the part's lowest possible point above the highest part or floor
  double interval = 0.10;     ///< s between parts
  double area = 0.8;          ///< share of the bin's length and width in which parts are released
  double speed = 0.0;         ///< m/s, largest random initial speed
  double spin = 2.0;          ///< rad/s, largest random initial spin
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
  void visit(ConfigVisitor& v);
  void validate() const;
};

struct DropResult {
  std::vector<BodyId> bodies;      ///< in order of release; index = heap index
  std::vector<std::size_t> parts;  ///< which part each is
  bool settled = false;
  double settle_time = 0;            ///< s after the last release
  std::vector<std::size_t> escaped;  ///< heap indices whose mass centre is outside the bin at rest
  double worst_penetration = 0;      ///< m
  bool damped = false;               ///< late damping acted
};

struct DropItem {
  const Part* part = nullptr;
  const CollisionShape* shape = nullptr;
  std::size_t part_index = 0;
};

/// The invisible tall walls that keep falling parts above the bin go away before this returns.
DropResult drop_parts(World& world, std::span<const DropItem> items, const BinSpec& bin, const Pose& X_WB,
                      const DropConfig& drop, const SettleConfig& settle, Seed seed);

/// Steps until every free body is at rest or the time limit is reached; returns whether at rest.
bool settle(World& world, const SettleConfig& config, double* time_used = nullptr);

}  // namespace binpick

// What a heap costs from the first spawn until it rests, as a trial drops it: the parts of a scene in its own bin.
// Beside it, step by step in turn, bare Bullet with the same bodies (sim/bare_bullet.hpp).
#pragma once

#include <cstdint>
#include <string>

namespace binpick {

struct SettleCost {
  std::string scene;
  std::uint64_t seed = 0;
  int parts = 0, fine_iterations = 0, coarse_iterations = 0;
  std::size_t pieces = 0;  ///< of the first part
  double cpu = 0;          ///< s of one core
  double simulated = 0;    ///< s, release of the parts included
  bool settled = false;
  std::size_t escaped = 0;
  double penetration = 0;  ///< m, deepest contact at rest
  std::size_t steps = 0;
  double bare_cpu = 0;        ///< s of one core, bare Bullet's steps alone; `cpu` holds all that is done for a heap
  std::size_t different = 0;  ///< steps after which bare Bullet had other bits

  double ratio() const { return cpu / bare_cpu; }
};

/// `parts` parts of the scene's first kind.
SettleCost bench_settle(const std::string& scene, int parts, std::uint64_t seed);

}  // namespace binpick

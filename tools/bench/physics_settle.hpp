// What a heap costs from the first spawn until it rests, as a trial drops it: the parts of a scene in its own bin.
#pragma once

#include <cstdint>
#include <string>

namespace binpick {

struct SettleCost {
  std::string scene;
  int parts = 0, iterations = 0;
  std::size_t pieces = 0;  ///< of the first part
  double cpu = 0;          ///< s of one core
  double simulated = 0;    ///< s, release of the parts included
  bool settled = false;
  std::size_t escaped = 0;
  double penetration = 0;  ///< m, deepest contact at rest
};

/// `parts` parts of the scene's first kind.
SettleCost bench_settle(const std::string& scene, int parts, std::uint64_t seed);

}  // namespace binpick

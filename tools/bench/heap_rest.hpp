// Many heaps of one scene, dropped and looked at as a trial does it: is each at rest, inside the bin, free of
// penetration, and the same bits however it is made?
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace binpick {

struct HeapRestConfig {
  std::string scene;
  int parts = 0;  ///< of the scene's first kind; 0: what the scene says
  std::uint64_t first_seed = 5000, last_seed = 5020;
  int workers = 1;
  bool fresh = false;  ///< every heap in a process of its own
};

struct HeapRest {
  std::uint64_t seed = 0;
  std::uint64_t hash = 0;  ///< of the world at rest
  int parts = 0, outside = 0, moved = 0;
  double settle_time = 0;            ///< s after the last release
  double settle_cpu = 0;             ///< s of one core from the first release to rest
  double check_cpu = 0;              ///< s, for the time it is kept awake, and for penetration
  double energy = 0, motion = 0;     ///< J, m: while kept awake
  std::vector<double> penetrations;  ///< m, true solids
  bool damped = false;
  std::string unsettled;  ///< why; empty when settled
};

/// One per seed, in order. Throws SpecError, AssetError; std::runtime_error when a process of its own died.
std::vector<HeapRest> rest_of_heaps(const HeapRestConfig& config);

}  // namespace binpick

// Heaps at rest for `binpick bench perception`. Settling takes seconds, looking takes milliseconds: the poses at rest
// are kept, in memory and, when a folder is named, as folder/<key>/<seed>.json with every bit. The key is a hash of all
// that the fall depends on (parts, bin, cell's furniture, drop, settle, physics) and of nothing else: neither sensor
// nor estimator changes it. It cannot know of changes in the simulator's own code: then empty the folder. Frame W,
// metres.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "trials/observation.hpp"

namespace binpick {

struct SettledHeap {
  bool usable = false;             ///< at rest, and every part inside the bin
  std::vector<std::size_t> parts;  ///< which part each body is, in heap order
  std::vector<Pose> X_WP;
  bool operator==(const SettledHeap& other) const;  ///< to the bit
};

/// Hash of everything that the heap of a seed depends on.
std::string heap_key(const Scenario& scenario, const TrialContext& context);

class HeapStore {
 public:
  /// `folder` empty: in memory only.
  explicit HeapStore(std::string folder) : folder_(std::move(folder)) {}
  /// The heap that a trial of this seed starts with: remembered, read, or else dropped and written. A file that does
  /// not fit is made anew. Throws StorageError.
  const SettledHeap& heap(const Scenario& scenario, const TrialContext& context, std::uint64_t seed);
  int dropped() const { return dropped_; }  ///< how many had to be dropped

 private:
  std::string folder_;
  std::map<std::pair<std::string, std::uint64_t>, SettledHeap> known_;
  int dropped_ = 0;
};

/// Puts the parts of a heap, or of none, into a cell in which nothing has been dropped: they stand fixed, and
/// observe() gives the bits that it gives after drop_heap().
void place_heap(const SettledHeap& heap, CellWorld& cell_world);

}  // namespace binpick

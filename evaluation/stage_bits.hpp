// Do two versions give the same bits, and if not, from which stage on? Hashes of a record are compared in the order in
// which the stages run; the first that differs is the one to look at, all later ones follow from it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "evaluation/pile_figures.hpp"

namespace binpick {

enum class Stage { kHeap, kFrame, kEstimates, kPick, kFigures };
/// "heap", "frame", "estimates", "pick" (planning and execution), "figures" (same hashes, other figures of the record).
const char* to_string(Stage stage);

struct BitDifference {
  std::uint64_t seed = 0;
  std::size_t turn = 0;  ///< of the loop; 0 for the heap
  Stage stage = Stage::kHeap;
};

/// The first stage in which two trials of one seed differ; none: every bit is equal. Records of another schema have
/// other contents always: then only the figures of the comparison are looked at, besides the stages.
std::optional<BitDifference> first_difference(const PileFigures& base, const PileFigures& fresh,
                                              bool same_schema = true);
/// "turn 3: estimates"; turns of the loop count from 0, as in records.
std::string describe(const BitDifference& difference);

}  // namespace binpick

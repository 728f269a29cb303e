#include "evaluation/stage_bits.hpp"

#include <algorithm>

namespace binpick {

const char* to_string(Stage stage) {
  switch (stage) {
    case Stage::kHeap:
      return "heap";
    case Stage::kFrame:
      return "frame";
    case Stage::kEstimates:
      return "estimates";
    case Stage::kPick:
      return "pick";
    case Stage::kFigures:
      return "figures";
  }
  return "";
}

std::optional<BitDifference> first_difference(const PileFigures& base, const PileFigures& fresh, bool same_schema) {
  const auto differs = [&](std::size_t turn, Stage stage) { return BitDifference{base.seed, turn, stage}; };
  if (base.heap_hash != fresh.heap_hash) return differs(0, Stage::kHeap);
  const std::size_t common = std::min(base.turns.size(), fresh.turns.size());
  for (std::size_t turn = 0; turn < common; ++turn) {
    const TurnHashes &a = base.turns[turn], &b = fresh.turns[turn];
    if (a.frame != b.frame) return differs(turn, Stage::kFrame);
    if (a.estimates != b.estimates) return differs(turn, Stage::kEstimates);
    if (a.world != b.world) return differs(turn, Stage::kPick);
  }
  const bool equal = same_schema ? base.content_hash == fresh.content_hash
                                 : base.turns.size() == fresh.turns.size() && same_figures(base, fresh);
  if (equal) return std::nullopt;
  // One went on where the other stopped: the last common turn ended otherwise.
  if (base.turns.size() != fresh.turns.size()) return differs(common == 0 ? 0 : common - 1, Stage::kPick);
  return differs(common == 0 ? 0 : common - 1, Stage::kFigures);
}

std::string describe(const BitDifference& difference) {
  if (difference.stage == Stage::kHeap) return "heap";
  if (difference.stage == Stage::kFigures) return "figures of the record";
  return "turn " + std::to_string(difference.turn) + ": " + to_string(difference.stage);
}

}  // namespace binpick

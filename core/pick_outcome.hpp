// How a pick ends. The first that happens wins; swing, neighbours moved and place error are fields beside it.
#pragma once

#include <string>
#include <vector>

namespace binpick {

enum class PickOutcome {
  kSucceeded,
  kBinEmpty,          ///< nothing left to pick: the trial is over
  kNoDetection,
  kNoReachablePick,   ///< detections, but no candidate survived planning
  kPathBlocked,       ///< the arm or tool met something on its way
  kNoSeal,            ///< no cup (or too few) sealed on the true surface
  kPulledOff,         ///< normal force or moment beyond the hold
  kSlipped,           ///< shear beyond the hold
  kDroppedInBin,      ///< lost between lift and tray, back into the bin
  kDoublePick,        ///< two parts were lifted
  kLostInTransit,     ///< lost outside bin and tray
  kWrongPlace,        ///< released, but not at rest in the tray
  kProtectiveStop,
  kUnsettled,         ///< the heap never came to rest, or a part lies outside the bin before the first pick
  kEstimatorFailed,
  kInternalError,     ///< our bug; recorded with its seed
};

std::string to_string(PickOutcome outcome);
PickOutcome pick_outcome_from(const std::string& text);  ///< throws SpecError
const std::vector<PickOutcome>& all_pick_outcomes();

}  // namespace binpick

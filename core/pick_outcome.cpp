#include "core/pick_outcome.hpp"

#include <array>

#include "core/error.hpp"

namespace binpick {
namespace {

struct Name {
  PickOutcome outcome;
  const char* text;
};

constexpr std::array kNames = {
    Name{PickOutcome::kSucceeded, "Succeeded"},           Name{PickOutcome::kBinEmpty, "BinEmpty"},
    Name{PickOutcome::kNoDetection, "NoDetection"},       Name{PickOutcome::kNoReachablePick, "NoReachablePick"},
    Name{PickOutcome::kPathBlocked, "PathBlocked"},       Name{PickOutcome::kNoSeal, "NoSeal"},
    Name{PickOutcome::kPulledOff, "PulledOff"},           Name{PickOutcome::kSlipped, "Slipped"},
    Name{PickOutcome::kDroppedInBin, "DroppedInBin"},     Name{PickOutcome::kDoublePick, "DoublePick"},
    Name{PickOutcome::kLostInTransit, "LostInTransit"},   Name{PickOutcome::kWrongPlace, "WrongPlace"},
    Name{PickOutcome::kProtectiveStop, "ProtectiveStop"}, Name{PickOutcome::kUnsettled, "Unsettled"},
    Name{PickOutcome::kEstimatorFailed, "EstimatorFailed"}, Name{PickOutcome::kInternalError, "InternalError"},
};

}  // namespace

std::string to_string(PickOutcome outcome) {
  for (const Name& name : kNames)
    if (name.outcome == outcome) return name.text;
  return "InternalError";
}

PickOutcome pick_outcome_from(const std::string& text) {
  for (const Name& name : kNames)
    if (text == name.text) return name.outcome;
  throw SpecError("'" + text + "' is not a pick outcome");
}

const std::vector<PickOutcome>& all_pick_outcomes() {
  static const std::vector<PickOutcome> all = [] {
    std::vector<PickOutcome> list;
    for (const Name& name : kNames) list.push_back(name.outcome);
    return list;
  }();
  return all;
}

}  // namespace binpick

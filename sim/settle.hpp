// Rest of a heap: how it is reached and told. Private detail of drop and settle that trials may use too.
#pragma once

#include <functional>

#include "sim/drop.hpp"

namespace binpick {

struct SettleReport {
  bool at_rest = false;
  double time = 0;      ///< s simulated
  bool damped = false;  ///< late damping acted
};

/// Steps until every free body is asleep, or moved less than `motion` in two windows in a row, or the time limit is
/// reached. At rest every free body is put to sleep: a heap is frozen while it is photographed and planned for.
SettleReport settle_report(World& world, const SettleConfig& config);

}  // namespace binpick

// Is a heap at rest really at rest? It is woken for a while with sleeping and damping off, and watched; and its true
// solids are looked for in each other.
#pragma once

#include <span>
#include <vector>

#include "sim/drop.hpp"
#include "sim/penetration.hpp"

namespace binpick {

inline constexpr double kMoved = 1e-4;  ///< m, a part that moves more counts as moved

/// Wakes `bodies` (free ones), forbids them to sleep for `duration` (s), and puts them back to sleep where they were,
/// to the bit: to look is not to touch.
WakeReport wake_and_watch(World& world, std::span<const BodyId> bodies, double duration);

/// The part's envelope, sampled finely enough for it.
SolidProbe probe_of(const Part& part);

/// Completes a result of drop_parts(): `woken`, `penetrations`, and whether it is settled after all. A heap whose parts
/// move on by more than `wake_motion` settles again, from where they have come to, as often as the time limit allows.
/// `probes[k]` is the solid of part k (DropItem::part_index).
void check_rest(World& world, const BinSpec& bin, const Pose& X_WB, std::span<const SolidProbe> probes,
                const SettleConfig& config, DropResult& drop);

}  // namespace binpick

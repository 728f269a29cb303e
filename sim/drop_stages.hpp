// Private to sim: the stages of which drop_parts() makes a heap.
#pragma once

#include <span>
#include <vector>

#include "sim/drop.hpp"

namespace binpick {

/// Releases the parts one after another over an open box, each from its own stream seed.child("part", k). Guard walls
/// are the caller's. Returns right after the last release.
std::vector<BodyId> rain_parts(World& world, std::span<const DropItem> items, const BinSpec& box, const Pose& X_WB,
                               const DropConfig& drop, Seed seed);

/// Rains the parts into a tote over the bin, waits until they lie, turns it over and takes it away: what is left inside
/// falls too. Throws SpecError when a part does not fit the tote.
std::vector<BodyId> dump_parts(World& world, std::span<const DropItem> items, const BinSpec& bin, const Pose& X_WB,
                               const DropConfig& drop, Seed seed);

/// Height over the bin's floor that guard walls of a dump need.
double dump_top(std::span<const DropItem> items, const BinSpec& bin, const DropConfig& drop);

/// Shakes all free bodies that are present; they are awake afterwards.
void shake(World& world, const ShakeConfig& config, Seed seed);

/// High enough for the topmost part that can be released over a box.
double guard_top(std::span<const DropItem> items, const BinSpec& box, const DropConfig& drop);

}  // namespace binpick

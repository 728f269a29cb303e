// The bin in the physics world: inner faces where BinSpec says, walls and floor thickened outwards so that a fast part
// cannot pass through them within one step.
#pragma once

#include "core/bin_spec.hpp"
#include "sim/world.hpp"

namespace binpick {

inline constexpr double kThickWall = 0.05;  ///< m, thickness of everything fixed that parts may fall on

BodyId add_bin(World& world, const BinSpec& bin, const Pose& X_WB);

/// The bin as it looks from outside as well, walls no thicker than drawn: what arm and tool may not touch.
BodyId add_drawn_bin(World& world, const BinSpec& bin, const Pose& X_WB);
TriangleMesh drawn_bin(const BinSpec& bin);  ///< in B

/// Invisible walls flush with the inner faces, from the rim up to `top` (m above the inner floor).
BodyId add_guard_walls(World& world, const BinSpec& bin, const Pose& X_WB, double top);

/// The point lies over the inner floor, not below it and not higher than `above_rim` over the rim.
bool inside_bin(const BinSpec& bin, const Pose& X_WB, const Eigen::Vector3d& p_W, double above_rim);

}  // namespace binpick

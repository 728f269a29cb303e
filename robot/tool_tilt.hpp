// How far the tool hangs off the vertical. A part held by vacuum peels where its weight comes to lie across the tool.
#pragma once

#include "robot/cell.hpp"

namespace binpick {

/// Angle between the tool's axis +z_G and straight down at joint position q: 0 .. pi.
double tool_tilt(const Cell& cell, const Vector6d& q);

/// Largest tilt along a path, looked at in steps of at most 0.02 rad of a joint or one sample.
double largest_tilt(const Cell& cell, const JointTrajectory& path);

}  // namespace binpick

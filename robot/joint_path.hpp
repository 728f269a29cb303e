// Joint motion through via points without a stop at them.
#pragma once

#include <vector>

#include "robot/trajectory.hpp"

namespace binpick {

/// From the first of `points` to the last, past the others: each inner point's corner is cut by a parabola that begins
/// and ends halfway to its neighbours, so the way keeps inside the triangles of every three points in a row. Rest to
/// rest, as fast as joint speeds and accelerations allow at every place of it. Two points: joint_move.
JointTrajectory joint_path(const Arm& arm, const std::vector<Vector6d>& points, const MotionLimits& limits);

}  // namespace binpick

// Can the tool's tip stand at a place? Joint limits only, no collisions: for validation and reach tables.
#pragma once

#include <Eigen/Core>

#include "robot/cell.hpp"

namespace binpick {

/// Some turn about the tool axis (of twelve) brings the tip to p_W with the tool pointing along `axis_W`.
bool reaches(const Cell& cell, const Eigen::Vector3d& p_W, const Eigen::Vector3d& axis_W);

}  // namespace binpick

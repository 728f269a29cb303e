// Where the next part goes in the tray: a grid of places as wide as the part, row after row, then a second layer on
// top.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.hpp"
#include "robot/cell.hpp"

namespace binpick {

struct TraySlot {
  Eigen::Vector2d center_T = Eigen::Vector2d::Zero();  ///< m, from the middle of the tray's floor
  int layer = 0;
};

/// Place of part number `placed` (from 0). A part wider than the tray gets its middle.
TraySlot tray_slot(const Eigen::Vector3d& inner_size, double diameter, int placed);

/// What a part of this outline takes up once it was let go of at X_WP: a box square to the tray, in W. It has come down
/// by up to `fall`.
Primitive box_in_tray(const TraySpec& tray, const std::vector<Eigen::Vector3d>& outline_P, const Pose& X_WP,
                      double fall);

/// A few dozen vertices that bound the mesh: the extreme one along each of 162 even directions.
std::vector<Eigen::Vector3d> outline_of(const TriangleMesh& mesh_P);

/// Extent of the points along a direction.
double height_along(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& direction);

}  // namespace binpick

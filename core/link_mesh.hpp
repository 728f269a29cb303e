// A mesh as a robot description names it: STL, DAE, OBJ or PLY, for bounding shapes only. Other people's link meshes
// are seldom closed, so nothing is repaired and no size is demanded (part meshes: mesh_io).
#pragma once

#include <string>

#include "core/mesh.hpp"

namespace binpick {

/// Vertices in the numbers of the file, as URDF wants them: metres. A DAE file's own unit is applied, its `up_axis` is
/// not (ROS ignores it). Throws AssetError in one line: missing, empty or damaged file, no triangle.
TriangleMesh read_link_mesh(const std::string& path);

}  // namespace binpick

// Private to robot: collision shapes of URDF links as primitives, and the files that their meshes are.
#pragma once

#include <string>
#include <vector>

#include "core/primitive.hpp"
#include "robot/arm.hpp"

namespace urdf {
class Link;
}

namespace binpick {

/// Shapes of `link` (the visual ones when it has no others), the link's frame at X_OL in the owner's O. Files of meshes
/// are added to `mesh_files`. Throws AssetError that starts with the URDF's path.
std::vector<Primitive> urdf_shapes(const urdf::Link& link, const Pose& X_OL, const ArmSource& source,
                                   std::vector<std::string>& mesh_files);

/// Boxes that hold all of `mesh_S` (frame S at X_OS in O): one around each slice across its longest edge, so that a
/// bent or hollow link is not one great box.
std::vector<Primitive> boxes_around(const TriangleMesh& mesh_S, const Pose& X_OS);

}  // namespace binpick

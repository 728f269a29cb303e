// Checked bytes -> triangles through assimp, one mesh per object, in the units of the file. Private to core.
#pragma once

#include <string>
#include <vector>

#include "core/mesh.hpp"

namespace binpick {

/// `extension` ("stl", "obj", "ply", "dae") alone chooses the importer; `bytes` must have passed mesh_bytes, but for
/// "dae", which nobody checks: run it isolated. Throws AssetError.
std::vector<TriangleMesh> import_mesh(const std::string& bytes, const std::string& extension, const std::string& path);

}  // namespace binpick

// STEP -> mesh through Open CASCADE. One .cpp file knows it; without BINPICK_WITH_STEP reading says so.
#pragma once

#include <string>

#include "core/mesh.hpp"

namespace binpick {

/// Tessellates every solid of a STEP file. `chord_tolerance` (m) bounds the distance between facets and surface; the
/// file's own length unit is honoured (mm, m, inch). Metres out. Throws AssetError.
TriangleMesh read_step(const std::string& path, double chord_tolerance);

}  // namespace binpick

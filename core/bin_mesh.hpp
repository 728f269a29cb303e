// A bin from CAD, what BinSpec::mesh names. Frame B: centre of the inner floor, z up, sides along x and y.
#pragma once

#include <string>
#include <vector>

#include "core/bin_spec.hpp"
#include "core/mesh_properties.hpp"

namespace binpick {

struct BinMesh {
  TriangleMesh mesh_B;  ///< closed
  MeshQuery surface;
  /// What of the surface does not lie in the plain floor and walls of the BinSpec (ribs, rounded corners, a rim), in
  /// boxes along the axes of B: with the plain boxes they hold all of it.
  std::vector<Primitive> beyond_plain;
};

/// Reads the mesh and holds it against the inner size, draft and wall that `bin` states: floor under z = 0, a wall on
/// each side where it says. Throws AssetError in one line: unreadable, open, or what is found elsewhere.
BinMesh read_bin_mesh(const BinSpec& bin);

}  // namespace binpick

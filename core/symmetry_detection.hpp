// The symmetry group of a part, found from its mesh. A rotation belongs to the group when it carries the whole surface
// to within `tolerance` times the diameter of itself. Frame P is the part as drawn.
//
// Every such rotation fixes the centroid of the surface and permutes the principal axes of its second moment. So the
// axes to try are few: the principal axes; where two principal moments are alike, also every direction across the
// third; where all three are alike, also the directions of faces, edges and corners.
#pragma once

#include "core/mesh.hpp"
#include "core/symmetry.hpp"

namespace binpick {

/// `tolerance` is a share of the diameter (0.01: a ring of 100 mm may be 1 mm out of round); 0.0001 .. 0.1. Orders up
/// to 64 are told from a revolution. An empty mesh has no symmetry.
Symmetry detect_symmetry(const TriangleMesh& mesh_P, double tolerance);

/// "none", "12 rotations", "revolution about (0 0 1), and upside down", "sphere": for people.
std::string describe(const Symmetry& symmetry);

}  // namespace binpick

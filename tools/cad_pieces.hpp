// Convex pieces and envelopes of our own parts, in metres, frame P. Round outlines become polygons of the same area, so
// that volume and mass are true.
#pragma once

#include <vector>

#include "core/mesh.hpp"

namespace binpick {

/// Closed ring of rectangular section about z, `facets` sides, its volume exactly that of the round ring.
TriangleMesh ring_envelope(double inner, double outer, double width, int facets);

/// The ring as twelve wedges with two outer facets each: a 24-gon outside, a 12-gon as hole.
std::vector<TriangleMesh> ring_wedges(double inner, double outer, double width);

std::vector<TriangleMesh> bearing_pieces();
std::vector<TriangleMesh> bracket_pieces();
std::vector<TriangleMesh> tee_pieces();
std::vector<TriangleMesh> bolt_pieces();   ///< head and shank, the chamfer left out
std::vector<TriangleMesh> gear_pieces();   ///< one a tooth, from the bore to its tip: gears mesh
std::vector<TriangleMesh> plate_pieces();  ///< ten blocks round the slot and the holes, which are square
std::vector<TriangleMesh> shaft_pieces();  ///< both halves, the chamfers left out

}  // namespace binpick

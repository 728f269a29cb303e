// The shapes of our own parts as Open CASCADE solids, written as STEP. Lengths in millimetres, as in the STEP files;
// frame P of each part is stated at its function. Only make_parts knows this.
#pragma once

#include <string>

namespace binpick {

/// Sealed bearing 6914: bore 70, outside 100, width 16; axis z, origin in the centre. Inner ring, outer ring, two seals
/// flush with the faces, and inside 16 balls and their cage, which no camera sees.
void write_bearing_step(const std::string& path);

/// L-bracket 90 x 60 x 60: base plate 90 x 60 x 8 on z = 0 with its corner at the origin, an upright 60 high along x =
/// 0 over a part of the base's width, holes, a slot and a boss. No symmetry.
void write_bracket_step(const std::string& path);

/// T-piece 64 x 60 x 16: a flat T extruded along z, bar 64 x 20 along x, stem 20 wide and 40 long towards -y; origin in
/// the middle of the bounding box. Symmetry: the half turn about its stem (y).
void write_tee_step(const std::string& path);

}  // namespace binpick

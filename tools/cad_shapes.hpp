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

/// Hexagon bolt M24 x 80: head 36 across flats and 15 high below z = 0, shank of 24 up to z = 80 with a chamfered end.
/// The thread is a plain cylinder. Symmetry: sixths of a turn about z.
void write_bolt_step(const std::string& path);

/// Spur gear, module 3, 24 involute teeth (20 degrees), 20 wide, bore 20; axis z, origin in the centre. Below the base
/// circle the flanks run radially to the root. Symmetry: 24 turns about z, and upside down.
void write_gear_step(const std::string& path);

/// Plate 100 x 60 x 4: two holes of 14 at x = +-34, a slot 10 x 36 across the middle; origin in the centre. Symmetry:
/// half turns about x, y and z.
void write_plate_step(const std::string& path);

/// Shaft 120 long, 35 thick for z < 0 and 25 for z > 0, chamfered ends. Symmetry: any turn about z.
void write_shaft_step(const std::string& path);

}  // namespace binpick

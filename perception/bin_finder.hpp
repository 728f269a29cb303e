// The bin, or the table, that a view shows: found where nothing is said of one, so that what comes after (crop, floor,
// walls, no pose through them) is the same as with a known bin. Patches of the view (surfels) vote for an upward
// direction, for the turn of walls upright on it, and for the place of each face; every set of faces that these allow
// is held against all patches (open_box): most patches on its faces, hardly one seen beyond them. At least two walls
// make a bin; sides without a wall are open. A floor alone is a table. Frame C, metres.
//
// What cannot be known: the sensor's constant disparity bias (bin_localisation reads it off the known distance of
// opposite walls). A floor that parts hide nearly everywhere is not found.
#pragma once

#include <optional>

#include "perception/open_box.hpp"

namespace binpick {

struct FoundBin {
  OpenBox box;  ///< the faces as fitted, open sides told
  BinSpec bin;  ///< upright walls, at the opening where they are drafted; open sides far enough out
  Pose X_CB = Pose::Identity();
  bool drafted = false;  ///< some wall leans by more than a degree
  int walls() const { return box.walls(); }
};

/// `largest_part`: diameter of the largest wanted part, m; a floor or wall reaches farther. Nothing: the view shows
/// neither bin nor table for certain. Needs camera, depth and noise of the scene; a function of them alone.
std::optional<FoundBin> find_bin(const Scene& scene, double largest_part);

/// Unmarks the wanted pixels within `margin` (m) of the faces as found, which may be drafted.
void unmark_faces(Scene& scene, const FoundBin& found, double margin);

}  // namespace binpick

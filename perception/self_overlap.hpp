// Where a part nearly looks like itself. Beyond its symmetry group a part can have poses that one side of it does not
// tell apart: the bare base of a bracket seen from behind, turned by half a turn. They are found once, from the CAD
// alone: the part is drawn small from the directions of its larger faces, of the edges between them and of its box, and
// every two drawings are laid on each other at every turn about the line of sight. Frame P, metres.
//
// A self-overlap T (pose in P) means: the part at X * T may look like the part at X. It is listed when it moves some
// point of the part by more than a tenth of the diameter from every equivalent place (less does not make a pose wrong),
// and when at least half of a drawing stays the same. Whether it does look alike in a given view is view_ambiguity's.
#pragma once

#include <cstddef>
#include <vector>

#include "core/mesh.hpp"
#include "core/symmetry.hpp"

namespace binpick {

struct SelfOverlap {
  Pose T = Pose::Identity();
  double alike = 0;  ///< largest share of a drawing that stays the same, 0.5 .. 1
};

/// At most `most` of them, the most alike first. Empty for an empty mesh.
std::vector<SelfOverlap> self_overlaps(const TriangleMesh& mesh_P, const Symmetry& symmetry, double diameter,
                                       std::size_t most = 16);

/// Largest distance of a point from the nearest equivalent place when the part is moved by T (MSSD of X * T against X).
double largest_shift(const Pose& T, const Symmetry& symmetry, const std::vector<Eigen::Vector3d>& points_P);

}  // namespace binpick

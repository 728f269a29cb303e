// How far convex pieces are from the solid that they stand for: volume of the symmetric difference, and distance
// between the two surfaces. Metres, both in the same frame. Measured by sampling with a fixed seed: the same meshes
// give the same figures, and the sampling error is stated beside them.
#pragma once

#include <vector>

#include "core/mesh.hpp"

namespace binpick {

struct ShapeErrorOptions {
  int cells = 160;      ///< along the longest edge: two lines through each cell of the broadest side are integrated
  int points = 150;     ///< along the diagonal of the box: spacing of the points on the surfaces
  double touch = 1e-4;  ///< share of the diagonal: pieces nearer to each other than this touch, no gap is between them
};

struct ShapeError {
  double volume = 0;           ///< m^3, of the solid
  double extra = 0;            ///< volume in a piece but not in the solid, share of the solid's volume
  double missing = 0;          ///< volume in the solid but in no piece, same unit
  double standard_error = 0;   ///< of extra + missing, by the two lines of each cell
  double solid_to_pieces = 0;  ///< m, the farthest point of the solid's surface from the surface of the union
  double pieces_to_solid = 0;  ///< m, the farthest point of the union's surface from the solid's
  double spacing = 0;          ///< m, of the points on both surfaces: distances are short by no more than about this

  double volume_error() const { return extra + missing; }
  double hausdorff() const { return solid_to_pieces > pieces_to_solid ? solid_to_pieces : pieces_to_solid; }
};

/// `solid` is closed, its triangles face outwards; bodies inside it count as solid. Pieces are closed and convex.
ShapeError shape_error(const TriangleMesh& solid, const std::vector<TriangleMesh>& pieces,
                       const ShapeErrorOptions& options = {});

/// The surface of the union of convex pieces: what of their faces lies inside no other piece (moved outwards by
/// `touch`, so that faces on which two pieces meet are no surface).
TriangleMesh union_surface(const std::vector<TriangleMesh>& pieces, double touch);

}  // namespace binpick

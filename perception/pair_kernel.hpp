// Private to voting and its table: the features of one reference with a whole list of partners, cut into cells, for
// wide registers. Same bits as pair_feature.hpp, pair by pair. Metres; free of Eigen.
#pragma once

#include "perception/pair_math.hpp"

namespace binpick {

/// A reference point and the rows of its canonical frame: x is its normal.
struct PairReference {
  float point[3] = {0, 0, 0};
  float x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
};

/// Partners, coordinate by coordinate: points and unit normals.
struct PairColumns {
  const float *px, *py, *pz, *nx, *ny, *nz;
};

struct PairLimits {
  PairSteps steps;
  float radius_squared = 1;  ///< m^2, longer pairs have no cell
};

/// For k in [0, count): cell[k] = cell of the pair (reference, partner k), or -1 for a pair that is too long or has no
/// length; alpha[k] = angle of the partner about the reference's normal, 0 .. 65535.
void pair_cells(const PairReference& reference, const PairColumns& partners, int count, const PairLimits& limits,
                int* cell, int* alpha);

}  // namespace binpick

// Private to icp.cpp: the normal equations of many scene points against the model's surface, eight points at a time.
// Plain numbers only, since the kernel is compiled for wide registers. Frame P for the model and the twists, C for the
// scene points; metres.
//
// For a scene point p (in P) and the nearest surface point q with normal n:
//   residual r = n . (p - q),   row a = (n, p x n),   weight w = 1 / (scale^2 (1 + (r / robust scale)^2))   (Cauchy)
// A point counts when q can be seen, r^2 and the distance beside the normal lie within the gate, and the normals agree.
#pragma once

#include <cstdint>

namespace binpick {

/// A surface point as the kernel reads it: half a cache line.
struct SurfacePoint {
  float p[3] = {}, n[3] = {};
  std::uint64_t views = 0;  ///< bit v: seen from view v
};
static_assert(sizeof(SurfacePoint) == 32);

/// "Which surface point is nearest": a grid of pairs of indices, -1 beyond the reach. The second of a pair is the
/// nearest point that faces the other way than the first: the one meant when the first cannot be seen (thin sheets).
struct SurfaceGrid {
  const std::int32_t* cells = nullptr;
  const SurfacePoint* points = nullptr;
  float low[3] = {};  ///< corner of cell (0, 0, 0)
  float inverse_cell = 1;
  std::int32_t size[3] = {};
};

/// Scene points and their normals (zero: none), `count` a multiple of 8; what fills up the last eight is NaN.
struct ScenePointsView {
  const float *x, *y, *z, *nx, *ny, *nz;
  int count = 0;
};

struct SurfaceQuery {
  float R_PC[9], p_PC[3];  ///< row by row; p_PC is also the eye
  int view = 0;
  float gate = 0;       ///< m^2
  float sideways = 0;   ///< m^2
  float agreement = 0;  ///< least cosine between the normals
  float scale = 1;      ///< m
  float robust = 1.5f;  ///< Cauchy's constant, of the scale
};

struct SurfaceSums {
  double A[21] = {};  ///< lower triangle row by row: (0,0), (1,0), (1,1), (2,0) ...
  double b[6] = {};
  double sum_abs = 0, sum_squares = 0, points = 0;
};

/// Adds all points to the sums.
void add_surface_points(const ScenePointsView& scene, const SurfaceGrid& grid, const SurfaceQuery& query,
                        SurfaceSums& sums);

}  // namespace binpick

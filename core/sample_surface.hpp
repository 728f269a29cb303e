// Even points on a mesh surface, with outward normals.
#pragma once

#include "core/mesh.hpp"
#include "core/point_cloud.hpp"
#include "core/random.hpp"

namespace binpick {

/// About area / spacing^2 points, stratified over the triangles by area (no two runs differ for the same seed).
PointCloud sample_surface(const TriangleMesh& mesh_P, double spacing, Seed seed);

}  // namespace binpick

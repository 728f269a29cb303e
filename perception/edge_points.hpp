// Oriented edge points: where a face ends. Each carries, in the place of a normal, the direction that leaves the face
// in its own plane. Voted with the very same pair feature they fix what flat faces leave free: a plate seen from above
// has one normal everywhere, but an outline. (Boundary-to-boundary pairs: Choi et al., ICRA 2012.)
#pragma once

#include "core/mesh.hpp"
#include "core/point_cloud.hpp"
#include "perception/scene.hpp"

namespace binpick {

/// Convex edges of the mesh sharper than 30 degrees, sampled every `spacing` (m); one point for each adjacent face.
/// Frame P. Edges buried in the mesh are left out as far as `outside` (points of the visible surface) does not reach.
PointCloud model_edges(const TriangleMesh& mesh_P, const PointCloud& outside_P, double spacing);

/// Wanted pixels beside which the scene steps back or has no depth, thinned to one a voxel and direction. Frame C.
PointCloud scene_edges(const Scene& scene, double voxel);

}  // namespace binpick

// An unordered cloud as the image of a made-up pinhole camera at the origin of C: about one point a pixel; the nearest
// point wins, averaged with those behind it that the stated noise cannot tell from it. Where the cloud has no normals
// they come from PCL.
#pragma once

#include "perception/normals.hpp"
#include "perception/scene.hpp"

namespace binpick {

/// Fills camera, depth and normals of `scene`, whose bin and X_CB are set; points behind the camera or beside the bin
/// are left out.
void organise_cloud(const PointCloud& cloud_C, const NormalsConfig& config, Scene& scene);

}  // namespace binpick

// Visible fraction of every part: pixels in the noise-free id image / pixels of the whole unoccluded silhouette, what
// lies outside the image included (the silhouette is drawn on an image wide enough to hold it).
#pragma once

#include <vector>

#include "sim/depth_renderer.hpp"

namespace binpick {

struct Visibility {
  int visible_pixels = 0;
  int silhouette_pixels = 0;
  double fraction() const { return silhouette_pixels > 0 ? double(visible_pixels) / silhouette_pixels : 0; }
};

/// One entry per part id 0 .. parts-1 of the scene. `frame` is the rendering of `scene` from the same camera; the
/// renderer draws only what reaches through the plane of the camera. The result does not depend on `threads`.
std::vector<Visibility> part_visibility(DepthRenderer& renderer, const RenderScene& scene, const ExactFrame& frame,
                                        const PinholeCamera& camera, const Pose& X_WC, std::size_t parts,
                                        int threads = 1);

}  // namespace binpick

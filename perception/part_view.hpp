// The part drawn at a pose, as the camera would see it alone: a crop of the image with the model's depth, and its
// outline with the outward direction of every outline pixel. Frame C; u, v are pixels of the whole image.
#pragma once

#include <cmath>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/pose.hpp"
#include "perception/surface_model.hpp"

namespace binpick {

struct PartView {
  int u0 = 0, v0 = 0;  ///< pixel of the image at the crop's (0, 0)
  Image<float> depth;  ///< m, +infinity outside the part; its border is always outside
  int pixels = 0;      ///< of the whole silhouette inside the image

  bool inside(int u, int v) const { return depth.contains(u - u0, v - v0) && std::isfinite(depth(u - u0, v - v0)); }
  float at(int u, int v) const { return depth(u - u0, v - v0); }
};

/// Empty when the part lies wholly outside the image or reaches behind the camera.
PartView draw_part(const PinholeCamera& camera, const SurfaceModel& model, const Pose& X_CP);

/// The same as a sensor shows it whose foreground grows by some pixels: gaps narrower than twice as much close.
/// `pixels` stays that of the part.
PartView grown(const PartView& view, int px);

struct OutlinePixel {
  int u = 0, v = 0;
  float z = 0;                                         ///< m, the model's depth there
  Eigen::Vector2f outward = Eigen::Vector2f::UnitX();  ///< unit, in the image
};

/// The silhouette's rim, row by row (holes included).
std::vector<OutlinePixel> outline_of(const PartView& view);

}  // namespace binpick

// Errors that look at pixels: VSD (visible surface discrepancy; Hodan et al., ECCV workshops 2016, ECCV 2018, in the
// form of the BOP challenge since 2019: step cost, pixels without depth count as visible) and CUS (complement over
// union of silhouettes). Parts are drawn with core/zbuffer at integer pixel centres; distances are lengths of rays, not
// z. Metres; poses in the camera's frame C.
#pragma once

#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/mesh.hpp"
#include "core/pose.hpp"
#include "core/zbuffer.hpp"

namespace binpick {

/// A part alone in the image: ray lengths inside `rect`, 0 where it is not.
struct DistancePatch {
  PixelRect rect;
  std::vector<double> distance;  ///< row by row

  double at(int u, int v) const {
    if (u < rect.u0 || u >= rect.u1 || v < rect.v0 || v >= rect.v1) return 0;
    return distance[static_cast<std::size_t>(v - rect.v0) * static_cast<std::size_t>(rect.width()) +
                    static_cast<std::size_t>(u - rect.u0)];
  }
};

struct VsdSettings {
  double delta = 0.015;  ///< m, tolerance of the visibility test; BOP takes 5 mm for ITODD, 15 mm else
  /// Shares of the diameter from which on a pixel is wrong; BOP: 0.05, 0.10 .. 0.50.
  std::vector<double> taus = {0.05, 0.10, 0.15, 0.20, 0.25, 0.30, 0.35, 0.40, 0.45, 0.50};
};

/// Depth (z, m; 0, infinite or NaN: none) to ray length; 0 where there is none.
Image<double> ray_lengths(const Image<float>& depth, const PinholeCamera& camera);

/// Draws one part after the other; a patch costs its own pixels only.
class PatchRenderer {
 public:
  explicit PatchRenderer(const PinholeCamera& camera) : buffer_(camera) {}
  DistancePatch draw(const TriangleMesh& mesh_P, const Pose& X_CP);

 private:
  ZBuffer buffer_;
};

/// One error for each tau, 0 .. 1; 1 when neither is visible.
std::vector<double> vsd_errors(const DistancePatch& est, const DistancePatch& truth, const Image<double>& seen,
                               double diameter, const VsdSettings& settings);

/// 1 - intersection / union of the silhouettes; 1 when both are empty.
double cus_error(const DistancePatch& est, const DistancePatch& truth);

}  // namespace binpick

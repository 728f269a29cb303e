#include "sim/noise/disparity_image.hpp"

#include <cmath>

#include "sim/noise/rows.hpp"

namespace binpick {

StereoView::StereoView(const ExactFrame& exact_frame, const PinholeCamera& left, double baseline_length,
                       int thread_count)
    : exact(exact_frame),
      camera(left),
      baseline(baseline_length),
      threads(thread_count),
      planes_(left.width, left.height) {
  for_rows(camera.height, threads, [&](int first, int end) {
    for (int v = first; v < end; ++v)
      for (int u = 0; u < camera.width; ++u)
        if (exact.ids(u, v) != kIdNothing) planes_(u, v) = plane_of(u, v);
  });
}

StereoView::Plane StereoView::plane_of(int u, int v) const {
  const Eigen::Vector3d n = exact.normals_C(u, v).cast<double>(), ray = camera.ray(u, v);
  const double d = fB() / exact.depth(u, v), here = n.dot(ray);
  Plane plane;
  plane.d = static_cast<float>(d);
  if (here < -1e-6) {  // edge-on the plane tells nothing
    plane.along_u = static_cast<float>(d * n.x() / (camera.fx * here));
    plane.along_v = static_cast<float>(d * n.y() / (camera.fy * here));
  }
  plane.cos_incidence = static_cast<float>(std::clamp(-here / ray.norm(), 0.0, 1.0));
  return plane;
}

}  // namespace binpick

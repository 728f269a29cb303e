#include "sim/noise/disparity_image.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {

double StereoView::disparity(std::size_t pixel) const {
  return exact.ids[pixel] == kIdNothing ? 0.0 : fB() / exact.depth[pixel];
}

double StereoView::disparity_at(std::size_t pixel, double u, double v) const {
  const double d = disparity(pixel);
  const Eigen::Vector3d n = exact.normals_C[pixel].cast<double>();
  const double here = n.dot(camera.ray(column(pixel), row(pixel)));
  if (!(here < -1e-6)) return d;  // edge-on: the plane tells nothing
  return std::clamp(d * n.dot(camera.ray(u, v)) / here, d - kMaxExtrapolation, d + kMaxExtrapolation);
}

double StereoView::cos_incidence(std::size_t pixel) const {
  const Eigen::Vector3d ray = camera.ray(column(pixel), row(pixel));
  return std::clamp(-exact.normals_C[pixel].cast<double>().dot(ray) / ray.norm(), 0.0, 1.0);
}

}  // namespace binpick

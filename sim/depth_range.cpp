#include "sim/depth_range.hpp"

#include <algorithm>

namespace binpick {

std::pair<double, double> depth_range(const RenderScene& scene, const Pose& X_WC) {
  double low = 1e9, high = 0;
  for (const RenderItem& item : scene.items) {
    const Pose X_CO = X_WC.inverse() * item.X_WO;
    for (const Eigen::Vector3d& p_O : item.mesh_O->vertices) {
      const double z = (X_CO * p_O).z();
      low = std::min(low, z);
      high = std::max(high, z);
    }
  }
  const double near = std::max(0.9 * low, 0.02);
  return {near, std::max(1.05 * high, 2 * near)};
}

}  // namespace binpick

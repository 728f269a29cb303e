#include "robot/tool_tilt.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {

double tool_tilt(const Cell& cell, const Vector6d& q) {
  const Eigen::Vector3d z_W = cell.tip_pose(q).linear().col(2);
  return std::atan2(z_W.head<2>().norm(), -z_W.z());
}

double largest_tilt(const Cell& cell, const JointTrajectory& path) {
  constexpr double kStep = 0.02;  // rad
  double most = tool_tilt(cell, path.q.front());
  Vector6d last = path.q.front();
  for (std::size_t k = 1; k < path.q.size(); ++k) {
    const Vector6d way = path.q[k] - last;
    const double moved = way.cwiseAbs().maxCoeff();
    if (moved < kStep && k + 1 < path.q.size()) continue;
    const int pieces = std::max(1, static_cast<int>(std::ceil(moved / kStep)));
    for (int i = 1; i <= pieces; ++i) most = std::max(most, tool_tilt(cell, last + way * (1.0 * i / pieces)));
    last = path.q[k];
  }
  return most;
}

}  // namespace binpick

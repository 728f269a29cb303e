#include "robot/tray_slots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace binpick {
namespace {

constexpr double kGap =
    0.008;  // m, between neighbours and to the walls: place errors of a few millimetres do not touch

int count_along(double length, double pitch) {
  return std::max(1, static_cast<int>(std::floor((length - kGap) / pitch)));
}

}  // namespace

TraySlot tray_slot(const Eigen::Vector3d& inner_size, double diameter, int placed) {
  const double pitch = diameter + kGap;
  const int nx = count_along(inner_size.x(), pitch), ny = count_along(inner_size.y(), pitch);
  const int in_layer = placed % (nx * ny);
  const int x = in_layer % nx, y = in_layer / nx;
  TraySlot slot;
  slot.layer = placed / (nx * ny);
  // The places spread over the whole tray.
  slot.center_T = {(x + 0.5) / nx * inner_size.x() - inner_size.x() / 2,
                   (y + 0.5) / ny * inner_size.y() - inner_size.y() / 2};
  return slot;
}

Primitive box_in_tray(const TraySpec& tray, const std::vector<Eigen::Vector3d>& outline_P, const Pose& X_WP,
                      double fall) {
  const Pose X_TP = tray.X_WT.inverse() * X_WP;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p_P : outline_P) box.extend(X_TP * p_P);
  box.min().z() -= fall;
  return Primitive::box(box.sizes(), tray.X_WT * Eigen::Translation3d(box.center()));
}

std::vector<Eigen::Vector3d> outline_of(const TriangleMesh& mesh_P) {
  constexpr int kDirections = 162;
  std::set<std::size_t> extreme;
  for (int i = 0; i < kDirections; ++i) {
    // Fibonacci sphere; the six axes are added below, so that boxes keep their exact heights.
    const double z = 1 - (2.0 * i + 1) / kDirections, angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3d d(r * std::cos(angle), r * std::sin(angle), z);
    std::size_t best = 0;
    for (std::size_t v = 1; v < mesh_P.vertices.size(); ++v)
      if (mesh_P.vertices[v].dot(d) > mesh_P.vertices[best].dot(d)) best = v;
    extreme.insert(best);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto less = [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; };
    const auto [low, high] = std::minmax_element(mesh_P.vertices.begin(), mesh_P.vertices.end(), less);
    extreme.insert(static_cast<std::size_t>(low - mesh_P.vertices.begin()));
    extreme.insert(static_cast<std::size_t>(high - mesh_P.vertices.begin()));
  }
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t v : extreme) points.push_back(mesh_P.vertices[v]);
  return points;
}

double height_along(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& direction) {
  double low = 1e9, high = -1e9;
  for (const Eigen::Vector3d& p : points) {
    low = std::min(low, p.dot(direction));
    high = std::max(high, p.dot(direction));
  }
  return high - low;
}

}  // namespace binpick

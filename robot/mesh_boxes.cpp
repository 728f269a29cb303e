#include <algorithm>
#include <cmath>

#include "core/mesh_properties.hpp"
#include "robot/urdf_shapes.hpp"

namespace binpick {
namespace {

constexpr double kSlice = 0.08;      // m, thickness aimed at
constexpr int kMostSlices = 6;       // every box costs time in each collision check
constexpr double kThinnest = 0.001;  // m: a flat mesh is still a solid

/// What of a triangle lies between low and high along `axis` goes into `box`: corners inside, and where edges cross.
void extend_by_slice(Eigen::AlignedBox3d& box, const std::array<Eigen::Vector3d, 3>& corners, int axis, double low,
                     double high) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d &a = corners[i], &b = corners[(i + 1) % 3];
    if (a[axis] >= low && a[axis] <= high) box.extend(a);
    for (const double cut : {low, high}) {
      if ((a[axis] - cut) * (b[axis] - cut) >= 0) continue;
      box.extend(Eigen::Vector3d(a + (cut - a[axis]) / (b[axis] - a[axis]) * (b - a)));
    }
  }
}

}  // namespace

std::vector<Primitive> boxes_around(const TriangleMesh& mesh_S, const Pose& X_OS) {
  const Eigen::AlignedBox3d whole = bounding_box(mesh_S);
  int axis = 0;
  const double length = whole.sizes().maxCoeff(&axis);
  const int slices = std::clamp(static_cast<int>(std::ceil(length / kSlice)), 1, kMostSlices);
  std::vector<Primitive> boxes;
  for (int k = 0; k < slices; ++k) {
    const double low = whole.min()[axis] + length * k / slices, high = whole.min()[axis] + length * (k + 1) / slices;
    Eigen::AlignedBox3d box;
    for (const auto& triangle : mesh_S.triangles)
      extend_by_slice(box, {mesh_S.vertices[triangle[0]], mesh_S.vertices[triangle[1]], mesh_S.vertices[triangle[2]]},
                      axis, low, high);
    if (box.isEmpty()) continue;
    boxes.push_back(Primitive::box(box.sizes().cwiseMax(kThinnest), X_OS * Eigen::Translation3d(box.center())));
  }
  return boxes;
}

}  // namespace binpick

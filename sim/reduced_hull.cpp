#include "sim/reduced_hull.hpp"

#include <LinearMath/btConvexHullComputer.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "core/convex_hull.hpp"

namespace binpick {
namespace {

struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

std::vector<Plane> planes_of(const TriangleMesh& hull) {
  std::vector<Plane> planes;
  for (const auto& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[t[0]];
    const Eigen::Vector3d n = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a);
    if (n.norm() < 1e-16) continue;
    planes.push_back({n.normalized(), n.normalized().dot(a)});
  }
  return planes;
}

/// Index of the point farthest outside of all planes, and how far.
std::pair<std::size_t, double> farthest_outside(const std::vector<Eigen::Vector3d>& points,
                                                const std::vector<Plane>& planes) {
  std::pair<std::size_t, double> best{0, 0.0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    double outside = -1;
    for (const Plane& plane : planes) outside = std::max(outside, plane.normal.dot(points[i]) - plane.offset);
    if (outside > best.second) best = {i, outside};
  }
  return best;
}

/// The extreme points along the axes and the space diagonals: where the growing hull starts.
std::vector<Eigen::Vector3d> extreme_points(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3d> extremes;
  for (int code = 0; code < 27; ++code) {
    const Eigen::Vector3d direction(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
    if (direction.isZero()) continue;
    const auto far = std::max_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
      return direction.dot(a) < direction.dot(b);
    });
    if (std::find(extremes.begin(), extremes.end(), *far) == extremes.end()) extremes.push_back(*far);
  }
  return extremes;
}

}  // namespace

TriangleMesh simplified_hull(const std::vector<Eigen::Vector3d>& points, std::size_t max_vertices, double tolerance) {
  TriangleMesh full = convex_hull(points);
  if (full.vertices.size() <= max_vertices) return full;
  std::vector<Eigen::Vector3d> kept = extreme_points(full.vertices);
  TriangleMesh hull = convex_hull(kept);
  while (!hull.empty() && kept.size() < max_vertices) {
    const auto [index, outside] = farthest_outside(full.vertices, planes_of(hull));
    if (outside <= tolerance) break;
    kept.push_back(full.vertices[index]);
    hull = convex_hull(kept);
  }
  return hull.empty() ? full : hull;
}

InsetHull inset_hull(const std::vector<Eigen::Vector3d>& points, double inset) {
  InsetHull result;
  // Millimetres, as the geometry code's own tolerances want it; at most 0.4 of the inner radius comes off.
  std::vector<Eigen::Vector3d> scaled;
  for (const Eigen::Vector3d& p : points) scaled.push_back(1e3 * p);
  btConvexHullComputer computer;
  const double taken = computer.compute(scaled.front().data(), sizeof(Eigen::Vector3d), static_cast<int>(scaled.size()),
                                        1e3 * inset, 0.4);
  if (taken <= 0 || computer.vertices.size() < 4) {
    result.vertices = points;
    return result;
  }
  result.inset = 1e-3 * taken;
  for (int i = 0; i < computer.vertices.size(); ++i) {
    const btVector3& v = computer.vertices[i];
    result.vertices.push_back(1e-3 * Eigen::Vector3d(v.x(), v.y(), v.z()));
  }
  return result;
}

double enclosed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Eigen::Vector3d origin = mesh.vertices.front();
  double volume = 0;
  for (const auto& t : mesh.triangles)
    volume +=
        (mesh.vertices[t[0]] - origin).dot((mesh.vertices[t[1]] - origin).cross(mesh.vertices[t[2]] - origin)) / 6;
  return volume;
}

}  // namespace binpick

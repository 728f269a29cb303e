#include "core/primitive.hpp"

#include <cmath>
#include <numbers>

namespace binpick {
namespace {

using Index = std::uint32_t;

TriangleMesh box_mesh(const Eigen::Vector3d& edges) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(0.5 * Eigen::Vector3d((i & 1 ? 1 : -1) * edges.x(), (i & 2 ? 1 : -1) * edges.y(),
                                                  (i & 4 ? 1 : -1) * edges.z()));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh cylinder_mesh(double radius, double length, int segments) {
  TriangleMesh mesh;
  const auto n = static_cast<Index>(segments);
  for (Index i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / segments;
    for (const double z : {-length / 2, length / 2})
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  mesh.vertices.emplace_back(0, 0, -length / 2);
  mesh.vertices.emplace_back(0, 0, length / 2);
  for (Index i = 0; i < n; ++i) {
    const Index a = 2 * i, b = 2 * ((i + 1) % n);
    mesh.triangles.push_back({a, b, a + 1});
    mesh.triangles.push_back({b, b + 1, a + 1});
    mesh.triangles.push_back({2 * n, b, a});
    mesh.triangles.push_back({2 * n + 1, a + 1, b + 1});
  }
  return mesh;
}

TriangleMesh sphere_mesh(double radius, int segments) {
  TriangleMesh mesh;
  const auto n = static_cast<Index>(segments), rings = n / 2;
  for (Index r = 1; r < rings; ++r) {
    const double polar = std::numbers::pi * r / rings;
    for (Index i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / segments;
      mesh.vertices.push_back(radius * Eigen::Vector3d(std::sin(polar) * std::cos(angle),
                                                       std::sin(polar) * std::sin(angle), std::cos(polar)));
    }
  }
  const auto top = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, radius);
  mesh.vertices.emplace_back(0, 0, -radius);
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n, last = (rings - 2) * n;
    mesh.triangles.push_back({top, i, j});
    mesh.triangles.push_back({top + 1, last + j, last + i});
    for (Index r = 0; r + 2 < rings; ++r) {
      const Index a = r * n + i, b = r * n + j;
      mesh.triangles.push_back({a, a + n, b});
      mesh.triangles.push_back({b, a + n, b + n});
    }
  }
  return mesh;
}

}  // namespace

Primitive Primitive::box(const Eigen::Vector3d& edges, const Pose& X_OS) { return {Kind::kBox, edges, X_OS}; }
Primitive Primitive::cylinder(double radius, double length, const Pose& X_OS) {
  return {Kind::kCylinder, {radius, length, 0}, X_OS};
}
Primitive Primitive::sphere(double radius, const Pose& X_OS) { return {Kind::kSphere, {radius, 0, 0}, X_OS}; }

TriangleMesh mesh_of(const Primitive& primitive, int segments) {
  const Eigen::Vector3d& s = primitive.size;
  switch (primitive.kind) {
    case Primitive::Kind::kBox:
      return transformed(primitive.X_OS, box_mesh(s));
    case Primitive::Kind::kCylinder:
      return transformed(primitive.X_OS, cylinder_mesh(s.x(), s.y(), segments));
    case Primitive::Kind::kSphere:
      return transformed(primitive.X_OS, sphere_mesh(s.x(), segments));
  }
  return {};
}

TriangleMesh transformed(const Pose& X_AB, const TriangleMesh& mesh_B) {
  TriangleMesh mesh_A = mesh_B;
  for (Eigen::Vector3d& vertex : mesh_A.vertices) vertex = X_AB * vertex;
  return mesh_A;
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto offset = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

}  // namespace binpick

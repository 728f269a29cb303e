#include "core/mesh_repair.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/mesh_properties.hpp"

namespace binpick {
namespace {

bool before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (a[k] != b[k]) return a[k] < b[k];
  }
  return false;
}

void renumber(TriangleMesh& mesh, const std::vector<std::uint32_t>& target) {
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = target[corner];
  }
}

/// Like first_at_same_position, for vertices that differ by less than `distance` along a sweep of the x axis.
std::vector<std::uint32_t> first_within(const std::vector<Eigen::Vector3d>& vertices, double distance) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return vertices[i].x() != vertices[j].x() ? vertices[i].x() < vertices[j].x() : i < j;
  });
  std::vector<std::uint32_t> target(vertices.size());
  std::iota(target.begin(), target.end(), 0u);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Eigen::Vector3d& p = vertices[order[i]];
    for (std::size_t j = i; j-- > 0 && p.x() - vertices[order[j]].x() < distance;) {
      if ((vertices[order[j]] - p).cwiseAbs().maxCoeff() < distance) {
        target[order[i]] = target[order[j]];
        break;
      }
    }
  }
  return target;
}

bool without_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  const Eigen::Vector3d ab = mesh.vertices[t[1]] - mesh.vertices[t[0]];
  const Eigen::Vector3d ac = mesh.vertices[t[2]] - mesh.vertices[t[0]];
  return ab.cross(ac).squaredNorm() == 0;
}

/// The triangle with its smallest corner first: equal for equal triangles of equal orientation.
std::array<std::uint32_t, 3> canonical(std::array<std::uint32_t, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::size_t drop_bad_triangles(TriangleMesh& mesh) {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::size_t>> keys;
  keys.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) keys.emplace_back(canonical(mesh.triangles[i]), i);
  std::sort(keys.begin(), keys.end());
  std::vector<char> keep(mesh.triangles.size(), 1);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first == keys[i - 1].first) keep[keys[i].second] = 0;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (keep[i] && !without_area(mesh, mesh.triangles[i])) mesh.triangles[kept++] = mesh.triangles[i];
  }
  const std::size_t dropped = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  return dropped;
}

void drop_unused_vertices(TriangleMesh& mesh) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) number[corner] = 0;
  }
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (number[i] == kUnused) continue;
    mesh.vertices[kept] = mesh.vertices[i];
    number[i] = kept++;
  }
  mesh.vertices.resize(kept);
  renumber(mesh, number);
}

}  // namespace

std::vector<std::uint32_t> first_at_same_position(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    if (before(vertices[i], vertices[j])) return true;
    if (before(vertices[j], vertices[i])) return false;
    return i < j;
  });
  std::vector<std::uint32_t> first(vertices.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  return first;
}

double signed_volume(const TriangleMesh& mesh) {
  const Eigen::Vector3d middle = bounding_box(mesh).center();
  double six_volumes = 0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]] - middle;
    const Eigen::Vector3d b = mesh.vertices[triangle[1]] - middle;
    six_volumes += a.dot(b.cross(mesh.vertices[triangle[2]] - middle));
  }
  return six_volumes / 6;
}

MeshRepairs repair_mesh(TriangleMesh& mesh, double weld_distance) {
  MeshRepairs repairs;
  const std::vector<std::uint32_t> first = first_at_same_position(mesh.vertices);
  for (std::size_t i = 0; i < first.size(); ++i) repairs.merged_vertices += first[i] != i;
  renumber(mesh, first);
  repairs.dropped_triangles = drop_bad_triangles(mesh);
  drop_unused_vertices(mesh);
  if (weld_distance > 0 && !mesh.empty() && !is_closed(mesh)) {
    TriangleMesh welded = mesh;
    const std::vector<std::uint32_t> near = first_within(mesh.vertices, weld_distance);
    renumber(welded, near);
    const std::size_t dropped = drop_bad_triangles(welded);
    if (!welded.empty() && is_closed(welded)) {
      for (std::size_t i = 0; i < near.size(); ++i) repairs.merged_vertices += near[i] != i;
      repairs.dropped_triangles += dropped;
      drop_unused_vertices(welded);
      mesh = std::move(welded);
    }
  }
  if (!mesh.empty() && !is_closed(mesh)) repairs.turned_triangles = turn_to_neighbours(mesh);
  if (!mesh.empty() && is_closed(mesh) && signed_volume(mesh) < 0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    repairs.turned_inside_out = true;
  }
  return repairs;
}

}  // namespace binpick

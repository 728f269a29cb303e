#include "core/sample_surface.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/check.hpp"
#include "core/mesh_properties.hpp"

namespace binpick {
namespace {

struct Patch {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal;
  double area;
};

/// Halves the triangle at its longest edge until every patch is below `limit`; neighbours stay neighbours in the list.
void add_patches(const Patch& patch, double limit, std::vector<Patch>& patches) {
  if (patch.area <= limit) {
    patches.push_back(patch);
    return;
  }
  std::size_t longest = 0;
  double length = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double edge = (patch.corners[(k + 1) % 3] - patch.corners[k]).squaredNorm();
    if (edge > length) {
      length = edge;
      longest = k;
    }
  }
  const Eigen::Vector3d& from = patch.corners[longest];
  const Eigen::Vector3d& to = patch.corners[(longest + 1) % 3];
  const Eigen::Vector3d& apex = patch.corners[(longest + 2) % 3];
  const Eigen::Vector3d middle = (from + to) / 2;
  add_patches({{from, middle, apex}, patch.normal, patch.area / 2}, limit, patches);
  add_patches({{middle, to, apex}, patch.normal, patch.area / 2}, limit, patches);
}

std::vector<Patch> make_patches(const TriangleMesh& mesh, double limit) {
  std::vector<Patch> patches;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double twice = normal.norm();
    if (twice > 0) add_patches({{a, b, c}, normal / twice, twice / 2}, limit, patches);
  }
  return patches;
}

}  // namespace

PointCloud sample_surface(const TriangleMesh& mesh_P, double spacing, Seed seed) {
  BP_CHECK(spacing > 0 && std::isfinite(spacing), "spacing " << spacing);
  constexpr double kMostPoints = 5e7;  // 2.4 GB of points and normals: beyond that the spacing cannot be meant
  const double total = surface_area(mesh_P);
  const double wanted = total / (spacing * spacing);
  BP_CHECK(wanted < kMostPoints, "spacing " << spacing << " on an area of " << total);
  if (!(total > 0)) return {};
  const std::vector<Patch> patches = make_patches(mesh_P, spacing * spacing);
  // Systematic sampling: one point in every n-th part of the area, taken along the list of patches.
  const auto count = static_cast<std::size_t>(std::max(1.0, std::round(wanted)));
  const Rng stream = seed.rng();
  PointCloud cloud;
  std::size_t at = 0;
  double before = 0;
  for (std::size_t k = 0; k < count; ++k) {
    Rng rng = stream.at(k);
    const double target = (static_cast<double>(k) + rng.uniform()) / static_cast<double>(count) * total;
    while (at + 1 < patches.size() && before + patches[at].area <= target) before += patches[at++].area;
    double u = rng.uniform();
    double v = rng.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const auto& [a, b, c] = patches[at].corners;
    cloud.points.push_back(a + u * (b - a) + v * (c - a));
    cloud.normals.push_back(patches[at].normal);
  }
  return cloud;
}

}  // namespace binpick

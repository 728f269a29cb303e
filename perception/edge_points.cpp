#include "perception/edge_points.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "perception/neighbours.hpp"
#include "perception/preprocess.hpp"

namespace binpick {
namespace {

constexpr double kSharp = 0.866;      // cosine of 30 degrees between the two faces
constexpr float kLeastJump = 0.006f;  // m, depth step of an edge
constexpr int kHalf = 3;              // px, window in which the outward direction is read

using Key = std::array<double, 3>;
Key key_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

struct Side {
  Eigen::Vector3d a, b;  // the edge as this face runs along it
  Eigen::Vector3d normal;
  Eigen::Vector3d outward;  // in the face's plane, away from the face
};

/// Every directed edge of the mesh, by the positions of its ends.
std::map<std::pair<Key, Key>, Side> sides_of(const TriangleMesh& mesh) {
  std::map<std::pair<Key, Key>, Side> sides;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]], &r = mesh.vertices[t[2]];
    const Eigen::Vector3d normal = (q - p).cross(r - p);
    if (!(normal.norm() > 0)) continue;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d &a = mesh.vertices[t[k]], &b = mesh.vertices[t[(k + 1) % 3]];
      const Eigen::Vector3d n = normal.normalized();
      sides.emplace(std::pair{key_of(a), key_of(b)}, Side{a, b, n, (b - a).cross(n).normalized()});
    }
  }
  return sides;
}

void sample_side(const Side& side, double spacing, PointCloud& out) {
  const double length = (side.b - side.a).norm();
  const int count = std::max(1, static_cast<int>(std::lround(length / spacing)));
  for (int i = 0; i < count; ++i) {
    out.points.push_back(side.a + (side.b - side.a) * ((i + 0.5) / count));
    out.normals.push_back(side.outward);
  }
}

/// Direction in the image in which the scene falls away from a pixel; zero where it does not.
Eigen::Vector2f falling_direction(const Scene& scene, int u, int v) {
  const float z = scene.depth(u, v), jump = std::max(kLeastJump, 4 * scene.sigma(z));
  const auto behind = [&](int a, int b) { return scene.depth.contains(a, b) && !(scene.depth(a, b) < z + jump); };
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  if (!behind(u - 1, v) && !behind(u + 1, v) && !behind(u, v - 1) && !behind(u, v + 1)) return sum;
  int count = 0;
  for (int b = -kHalf; b <= kHalf; ++b)
    for (int a = -kHalf; a <= kHalf; ++a)
      if (behind(u + a, v + b)) {
        sum += Eigen::Vector2f(static_cast<float>(a), static_cast<float>(b));
        ++count;
      }
  // A hole of a few pixels is no edge; nor is a thin bridge that falls away on both sides.
  if (count < kHalf * (2 * kHalf + 1) / 2 || sum.norm() < 0.8f * static_cast<float>(count))
    return Eigen::Vector2f::Zero();
  return sum.normalized();
}

Eigen::Vector3f mean_normal(const Scene& scene, int u, int v) {
  const float z = scene.depth(u, v), jump = std::max(kLeastJump, 4 * scene.sigma(z));
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (int b = -kHalf; b <= kHalf; ++b)
    for (int a = -kHalf; a <= kHalf; ++a)
      if (scene.depth.contains(u + a, v + b) && std::abs(scene.depth(u + a, v + b) - z) < jump)
        mean += scene.normals(u + a, v + b);
  return mean.squaredNorm() > 0.25f ? Eigen::Vector3f(mean.normalized()) : Eigen::Vector3f::Zero();
}

}  // namespace

PointCloud model_edges(const TriangleMesh& mesh_P, const PointCloud& outside_P, double spacing) {
  const auto sides = sides_of(mesh_P);
  PointCloud all;
  for (const auto& [ends, side] : sides) {
    const auto other = sides.find({ends.second, ends.first});
    if (other == sides.end() || side.normal.dot(other->second.normal) > kSharp) continue;
    if (side.outward.dot(other->second.normal) < 0) continue;  // a reentrant corner: no depth step there
    sample_side(side, spacing, all);
  }
  std::vector<Eigen::Vector3f> outside;
  for (const Eigen::Vector3d& p : outside_P.points) outside.push_back(p.cast<float>());
  const PointGrid grid(outside, static_cast<float>(2 * spacing));
  PointCloud visible;
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool near = false;
    grid.within(all.points[i].cast<float>(), static_cast<float>(spacing), [&](std::uint32_t) { near = true; });
    if (!near) continue;
    visible.points.push_back(all.points[i]);
    visible.normals.push_back(all.normals[i]);
  }
  return voxel_grid(visible, spacing);
}

PointCloud scene_edges(const Scene& scene, double voxel) {
  PointCloud edges;
  for (int v = kHalf; v + kHalf < scene.depth.height(); ++v)
    for (int u = kHalf; u + kHalf < scene.depth.width(); ++u) {
      if (!scene.wanted(u, v)) continue;
      const Eigen::Vector2f g = falling_direction(scene, u, v);
      if (g.isZero()) continue;
      const Eigen::Vector3f n = mean_normal(scene, u, v);
      if (n.isZero()) continue;
      const Eigen::Vector3f g3(g.x(), g.y(), 0), out = g3 - n * n.dot(g3);
      if (out.norm() < 0.3f) continue;  // the face is seen nearly edge-on
      const float z = scene.depth(u, v), inward = static_cast<float>(scene.noise.fattening_px) * scene.pixel(z);
      edges.points.push_back((scene.point(u, v, z) - out.normalized() * inward).cast<double>());
      edges.normals.push_back(out.normalized().cast<double>());
    }
  return voxel_grid(edges, voxel);
}

}  // namespace binpick

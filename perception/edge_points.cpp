#include "perception/edge_points.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "perception/neighbours.hpp"
#include "perception/preprocess.hpp"

namespace binpick {
namespace {

constexpr double kSharp = 0.866;      // cosine of 30 degrees between the two faces
constexpr float kLeastJump = 0.002f;  // m, depth step of an edge
constexpr int kHalf = 3;              // px, window in which the outward direction is read

struct Side {
  Eigen::Vector3d a, b;  // the edge as this face runs along it
  Eigen::Vector3d normal;
  Eigen::Vector3d outward;  // in the face's plane, away from the face
};

/// Of every vertex, its place among all positions in the order of x, y, z: corners at one position have one rank.
std::vector<std::uint32_t> ranks_of(const std::vector<Eigen::Vector3d>& vertices) {
  const auto before = [&](std::uint32_t i, std::uint32_t k) {
    const Eigen::Vector3d &a = vertices[i], &b = vertices[k];
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::vector<std::uint32_t> order(vertices.size()), ranks(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), before);
  for (std::size_t i = 1; i < order.size(); ++i) ranks[order[i]] = ranks[order[i - 1]] + before(order[i - 1], order[i]);
  return ranks;
}

/// Every directed edge of the mesh, by the positions of its ends; of several with the same ends the first.
class Sides {
 public:
  explicit Sides(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> ranks = ranks_of(mesh.vertices);
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3d &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]], &r = mesh.vertices[t[2]];
      const Eigen::Vector3d normal = (q - p).cross(r - p);
      if (!(normal.norm() > 0)) continue;
      const Eigen::Vector3d n = normal.normalized();
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        const Eigen::Vector3d &a = mesh.vertices[from], &b = mesh.vertices[to];
        keys_.push_back({ends(ranks[from], ranks[to]), static_cast<std::uint32_t>(sides_.size())});
        sides_.push_back({a, b, n, (b - a).cross(n).normalized()});
      }
    }
    std::sort(keys_.begin(), keys_.end());
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    keys_.erase(std::unique(keys_.begin(), keys_.end(), same), keys_.end());
  }

  /// visit(side, the same edge as the neighbouring face runs along it) for all that have a neighbour.
  template <class Visit>
  void each_with_other(Visit&& visit) const {
    for (const auto& [key, side] : keys_) {
      const std::pair<std::uint64_t, std::uint32_t> back{(key << 32) | (key >> 32), 0};
      const auto other = std::lower_bound(keys_.begin(), keys_.end(), back);
      if (other != keys_.end() && other->first == back.first) visit(sides_[side], sides_[other->second]);
    }
  }

 private:
  static std::uint64_t ends(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }
  std::vector<Side> sides_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys_;  // ranks of the two ends, then the side
};

void sample_side(const Side& side, double spacing, PointCloud& out) {
  const double length = (side.b - side.a).norm();
  const int count = std::max(1, static_cast<int>(std::lround(length / spacing)));
  for (int i = 0; i < count; ++i) {
    out.points.push_back(side.a + (side.b - side.a) * ((i + 0.5) / count));
    out.normals.push_back(side.outward);
  }
}

/// A wanted pixel at least kHalf from the image's border, with what a depth jump is there.
struct Place {
  const Scene& scene;
  int u, v;
  float z, jump;

  Place(const Scene& s, int u_px, int v_px) : scene(s), u(u_px), v(v_px), z(s.depth(u, v)) {
    jump = std::max(kLeastJump, 4 * scene.sigma(z));
  }
  /// Or unknown, or the known floor, which ends a surface however near it is: a plate that lies flat on it has no depth
  /// step to speak of.
  bool behind(int a, int b) const {
    const float seen = scene.depth(u + a, v + b);
    return !(seen < z + jump) || (!scene.wanted(u + a, v + b) && seen > z - jump);
  }
};

/// Direction in the image in which the scene falls away from a pixel; zero where it does not.
Eigen::Vector2f falling_direction(const Place& at) {
  if (!at.behind(-1, 0) && !at.behind(1, 0) && !at.behind(0, -1) && !at.behind(0, 1)) return Eigen::Vector2f::Zero();
  int sum_a = 0, sum_b = 0, count = 0;
  for (int b = -kHalf; b <= kHalf; ++b)
    for (int a = -kHalf; a <= kHalf; ++a) {
      const int is = at.behind(a, b);
      sum_a += is * a, sum_b += is * b, count += is;
    }
  const Eigen::Vector2f sum(static_cast<float>(sum_a), static_cast<float>(sum_b));
  // A hole of a few pixels is no edge; nor is a thin bridge that falls away on both sides.
  if (count < kHalf * (2 * kHalf + 1) / 2 || sum.norm() < 0.8f * static_cast<float>(count))
    return Eigen::Vector2f::Zero();
  return sum.normalized();
}

Eigen::Vector3f mean_normal(const Place& at) {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (int b = -kHalf; b <= kHalf; ++b)
    for (int a = -kHalf; a <= kHalf; ++a)
      if (std::abs(at.scene.depth(at.u + a, at.v + b) - at.z) < at.jump) mean += at.scene.normals(at.u + a, at.v + b);
  return mean.squaredNorm() > 0.25f ? Eigen::Vector3f(mean.normalized()) : Eigen::Vector3f::Zero();
}

/// Edge points of a row, moved back by what the sensor lets the foreground grow.
void edges_of_row(const Scene& scene, int v, PointCloud& out) {
  for (int u = kHalf; u + kHalf < scene.depth.width(); ++u) {
    if (!scene.wanted(u, v)) continue;
    const Place at(scene, u, v);
    const Eigen::Vector2f g = falling_direction(at);
    if (g.isZero()) continue;
    const Eigen::Vector3f n = mean_normal(at);
    if (n.isZero()) continue;
    const Eigen::Vector3f g3(g.x(), g.y(), 0), outward = g3 - n * n.dot(g3);
    if (outward.norm() < 0.3f) continue;  // the face is seen nearly edge-on
    const float inward = static_cast<float>(scene.noise.fattening_px) * scene.pixel(at.z);
    out.points.push_back((scene.point(u, v, at.z) - outward.normalized() * inward).cast<double>());
    out.normals.push_back(outward.normalized().cast<double>());
  }
}

}  // namespace

PointCloud model_edges(const TriangleMesh& mesh_P, const PointCloud& outside_P, double spacing) {
  PointCloud all;
  Sides(mesh_P).each_with_other([&](const Side& side, const Side& other) {
    if (side.normal.dot(other.normal) > kSharp) return;
    if (side.outward.dot(other.normal) < 0) return;  // a reentrant corner: no depth step there
    sample_side(side, spacing, all);
  });
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
  for (int v = kHalf; v + kHalf < scene.depth.height(); ++v) edges_of_row(scene, v, edges);
  return voxel_grid(edges, voxel);
}

}  // namespace binpick

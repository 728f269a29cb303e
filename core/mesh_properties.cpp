#include "core/mesh_properties.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/check.hpp"
#include "core/convex_hull.hpp"
#include "core/mesh_repair.hpp"

namespace binpick {
namespace {

/// A median-split tree over points, for the search of the farthest one.
class FarthestPoint {
 public:
  explicit FarthestPoint(std::vector<Eigen::Vector3d> points) : points_(std::move(points)) {
    if (!points_.empty()) build(0, points_.size());
  }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }

  /// Largest squared distance from p, if above `best`; otherwise `best`.
  double squared_distance(const Eigen::Vector3d& p, double best) const {
    return nodes_.empty() ? best : search(0, p, best);
  }

 private:
  static constexpr std::size_t kLeafSize = 8;
  struct Node {
    Eigen::AlignedBox3d box;
    std::size_t begin = 0, end = 0;
    std::size_t right = 0;  ///< second child; the first follows its parent; 0: a leaf
  };

  void build(std::size_t begin, std::size_t end) {
    const std::size_t self = nodes_.size();
    nodes_.push_back({{}, begin, end, 0});
    Eigen::AlignedBox3d box;
    for (std::size_t i = begin; i < end; ++i) box.extend(points_[i]);
    nodes_[self].box = box;
    if (end - begin <= kLeafSize) return;
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    build(begin, middle);
    nodes_[self].right = nodes_.size();
    build(middle, end);
  }

  double search(std::size_t index, const Eigen::Vector3d& p, double best) const {
    const Node& node = nodes_[index];
    const Eigen::Vector3d far = (p - node.box.min()).cwiseAbs().cwiseMax((p - node.box.max()).cwiseAbs());
    if (far.squaredNorm() <= best) return best;
    if (node.right == 0) {
      for (std::size_t i = node.begin; i < node.end; ++i) best = std::max(best, (points_[i] - p).squaredNorm());
      return best;
    }
    best = search(index + 1, p, best);
    return search(node.right, p, best);
  }

  std::vector<Eigen::Vector3d> points_;
  std::vector<Node> nodes_;
};

}  // namespace

MassProperties mass_properties(const TriangleMesh& mesh_P, double density) {
  BP_CHECK(!mesh_P.empty());
  const Eigen::Vector3d p_ref = bounding_box(mesh_P).center();  // near the part: no cancellation far from the origin
  double volume = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& triangle : mesh_P.triangles) {
    // Tetrahedron (0, a, b, c): volume det/6, centroid sum/4, integral of x x^T = det/120 (s s^T + a a^T + b b^T + c
    // c^T).
    const Eigen::Vector3d a = mesh_P.vertices[triangle[0]] - p_ref;
    const Eigen::Vector3d b = mesh_P.vertices[triangle[1]] - p_ref;
    const Eigen::Vector3d c = mesh_P.vertices[triangle[2]] - p_ref;
    const double det = a.dot(b.cross(c));
    const Eigen::Vector3d sum = a + b + c;
    volume += det / 6;
    first += det / 24 * sum;
    second += det / 120 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  BP_CHECK(volume > 0, "volume " << volume);
  MassProperties result;
  result.volume = volume;
  result.mass = density * volume;
  const Eigen::Vector3d center = first / volume;
  result.center_P = p_ref + center;
  const Eigen::Matrix3d spread = second - volume * center * center.transpose();
  result.inertia_P = density * (spread.trace() * Eigen::Matrix3d::Identity() - spread);
  return result;
}

bool is_closed(const TriangleMesh& mesh) {
  if (mesh.empty()) return false;
  const std::vector<std::uint32_t> first = first_at_same_position(mesh.vertices);
  struct Edge {
    std::uint32_t low, high;
    int direction;
    bool operator<(const Edge& other) const { return std::pair(low, high) < std::pair(other.low, other.high); }
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = first[triangle[k]];
      const std::uint32_t to = first[triangle[(k + 1) % 3]];
      if (from != to) edges.push_back(from < to ? Edge{from, to, 1} : Edge{to, from, -1});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    int balance = 0;
    const std::size_t begin = i;
    for (; i < edges.size() && !(edges[begin] < edges[i]); ++i) balance += edges[i].direction;
    if (balance != 0) return false;
  }
  return !edges.empty();
}

double mesh_diameter(const TriangleMesh& mesh) {
  const FarthestPoint tree(hull_vertices(mesh));
  double best = 0;
  for (const Eigen::Vector3d& point : tree.points()) best = tree.squared_distance(point, best);
  return std::sqrt(best);
}

std::vector<Eigen::Vector3d> hull_vertices(const TriangleMesh& mesh) {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) used[corner] = 1;
  }
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) points.push_back(mesh.vertices[i]);
  }
  std::vector<Eigen::Vector3d> result;
  for (const std::uint32_t i : hull_indices(points)) result.push_back(points[i]);
  return result;
}

Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) box.extend(mesh.vertices[corner]);
  }
  return box;
}

double surface_area(const TriangleMesh& mesh) {
  double twice = 0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
    twice += (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).norm();
  }
  return twice / 2;
}

}  // namespace binpick

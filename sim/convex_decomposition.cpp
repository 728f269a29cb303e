#include "sim/convex_decomposition.hpp"

#include <HACD/hacdHACD.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/convex_hull.hpp"
#include "sim/reduced_hull.hpp"

namespace binpick {
namespace {

/// Vertices on a grid of `cell` metres count as one (0: only equal ones); triangles that collapse go away.
TriangleMesh welded(const TriangleMesh& mesh, double cell) {
  std::map<std::array<double, 3>, std::uint32_t> seen;
  TriangleMesh result;
  std::vector<std::uint32_t> index;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    std::array<double, 3> key{v.x(), v.y(), v.z()};
    if (cell > 0)
      for (double& c : key) c = std::floor(c / cell + 0.5);
    const auto [it, fresh] = seen.try_emplace(key, static_cast<std::uint32_t>(result.vertices.size()));
    if (fresh) result.vertices.push_back(v);
    index.push_back(it->second);
  }
  for (const auto& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> welded_t{index[t[0]], index[t[1]], index[t[2]]};
    if (welded_t[0] == welded_t[1] || welded_t[1] == welded_t[2] || welded_t[2] == welded_t[0]) continue;
    result.triangles.push_back(welded_t);
  }
  return result;
}

double diagonal_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

TriangleMesh thinned(const TriangleMesh& mesh, std::size_t max_triangles) {
  TriangleMesh result = welded(mesh, 0);
  for (double cell = diagonal_of(mesh) / 200; result.triangles.size() > max_triangles; cell *= 1.4)
    result = welded(mesh, cell);
  return result;
}

using Points = std::vector<Eigen::Vector3d>;

/// Point sets of HACD's clusters. Its tolerances are made for numbers about 1: millimetres go in.
std::vector<Points> hacd_clusters(const TriangleMesh& mesh) {
  std::vector<HACD::Vec3<HACD::Real>> points;
  std::vector<HACD::Vec3<long>> triangles;
  for (const Eigen::Vector3d& v : mesh.vertices) points.emplace_back(1e3 * v.x(), 1e3 * v.y(), 1e3 * v.z());
  for (const auto& t : mesh.triangles) triangles.emplace_back(long(t[0]), long(t[1]), long(t[2]));
  HACD::HACD hacd;
  hacd.SetPoints(points.data());
  hacd.SetNPoints(points.size());
  hacd.SetTriangles(triangles.data());
  hacd.SetNTriangles(triangles.size());
  hacd.SetCompacityWeight(1e-4);
  hacd.SetVolumeWeight(0.0);
  hacd.SetNClusters(2);
  hacd.SetNVerticesPerCH(100);
  hacd.SetConcavity(2.0);
  hacd.SetAddExtraDistPoints(true);
  hacd.SetAddNeighboursDistPoints(true);
  hacd.SetAddFacesPoints(true);
  hacd.Compute();
  std::vector<Points> clusters(hacd.GetNClusters());
  const long* partition = hacd.GetPartition();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      clusters[static_cast<std::size_t>(partition[t])].push_back(mesh.vertices[v]);
  return clusters;
}

struct Cluster {
  Points points;
  double volume = 0;
  double air = 0;  ///< what all its merges added together
};

Cluster cluster_of(const Points& points) {
  const TriangleMesh hull = convex_hull(points);
  if (hull.empty()) return {points, 0, 0};
  return {hull.vertices, enclosed_volume(hull), 0};
}

Cluster merged(const Cluster& a, const Cluster& b) {
  Points points = a.points;
  points.insert(points.end(), b.points.begin(), b.points.end());
  Cluster result = cluster_of(points);
  result.air = a.air + b.air + std::max(0.0, result.volume - a.volume - b.volume);
  return result;
}

/// The cheapest merge first, until each would add more air than allowed and there are few enough pieces. The costs of
/// pairs are kept in a table, so that a merge computes one row and not all pairs again.
class Merger {
 public:
  explicit Merger(std::vector<Cluster> clusters)
      : clusters_(std::move(clusters)), alive_(clusters_.size(), true), left_(clusters_.size()) {
    excess_.assign(clusters_.size(), std::vector<double>(clusters_.size(), INFINITY));
    for (std::size_t a = 0; a < clusters_.size(); ++a) fill_row(a, a + 1);
  }

  std::vector<Cluster> run(double allowed, std::size_t max_pieces) {
    while (left_ > 1) {
      const auto [a, b] = cheapest();
      if (excess_[a][b] > allowed && left_ <= max_pieces) break;
      clusters_[a] = merged(clusters_[a], clusters_[b]);
      alive_[b] = false;
      --left_;
      fill_row(a, 0);
    }
    std::vector<Cluster> result;
    for (std::size_t i = 0; i < clusters_.size(); ++i)
      if (alive_[i]) result.push_back(clusters_[i]);
    return result;
  }

 private:
  void fill_row(std::size_t a, std::size_t first) {
    for (std::size_t b = first; b < clusters_.size(); ++b) {
      if (b == a || !alive_[b]) continue;
      excess_[std::min(a, b)][std::max(a, b)] = merged(clusters_[a], clusters_[b]).air;
    }
  }
  std::pair<std::size_t, std::size_t> cheapest() const {
    std::pair<std::size_t, std::size_t> best{0, 0};
    double least = INFINITY;
    for (std::size_t a = 0; a < clusters_.size(); ++a)
      for (std::size_t b = a + 1; b < clusters_.size(); ++b)
        if (alive_[a] && alive_[b] && excess_[a][b] < least) least = excess_[a][b], best = {a, b};
    return best;
  }

  std::vector<Cluster> clusters_;
  std::vector<bool> alive_;
  std::size_t left_;
  std::vector<std::vector<double>> excess_;
};

}  // namespace

std::vector<TriangleMesh> convex_decomposition(const TriangleMesh& mesh, const DecompositionLimits& limits) {
  const TriangleMesh whole = simplified_hull(mesh.vertices, limits.max_vertices, limits.tolerance);
  if (whole.empty()) return {};
  const double volume = std::abs(enclosed_volume(mesh));
  if (enclosed_volume(convex_hull(mesh.vertices)) - volume < limits.convex_enough * volume) return {whole};
  std::vector<Cluster> clusters;
  for (const Points& points : hacd_clusters(thinned(mesh, limits.max_triangles)))
    if (!points.empty()) clusters.push_back(cluster_of(points));
  std::vector<TriangleMesh> pieces;
  for (const Cluster& cluster : Merger(std::move(clusters)).run(limits.merge_excess * volume, limits.max_pieces)) {
    TriangleMesh piece = simplified_hull(cluster.points, limits.max_vertices, limits.tolerance);
    if (!piece.empty()) pieces.push_back(std::move(piece));
  }
  return pieces.empty() ? std::vector<TriangleMesh>{whole} : pieces;
}

}  // namespace binpick

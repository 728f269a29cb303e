#include "sim/convex_decomposition.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/convex_hull.hpp"
#include "core/mesh_properties.hpp"
#include "sim/reduced_hull.hpp"
#include "sim/shape_error.hpp"
#include "sim/solid_region.hpp"

namespace binpick {
namespace {

constexpr double kSmallTolerance = 2e-3;  // of the mesh's diagonal, whatever the limits say

using Points = std::vector<Eigen::Vector3d>;

struct Cluster {
  Points points;
  double volume = 0;
  double air = 0;  ///< in its hull, but not in the solid
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

/// The hull of the points with few corners; with twice as many where round sides would lose too much by that.
TriangleMesh piece_of(const Points& points, const DecompositionLimits& limits) {
  const TriangleMesh hull = simplified_hull(points, limits.max_vertices, limits.tolerance);
  if (hull.vertices.size() < limits.max_vertices) return hull;
  const double full = enclosed_volume(convex_hull(points));
  if (enclosed_volume(hull) >= (1 - limits.round_loss) * full) return hull;
  return simplified_hull(points, 2 * limits.max_vertices, limits.tolerance);
}

/// The cheapest merge first, for as long as the limits want fewer pieces. What pairs would add is kept in a table, so
/// that a merge computes one row and not all pairs again.
class Merger {
 public:
  explicit Merger(std::vector<Cluster> clusters)
      : clusters_(std::move(clusters)), alive_(clusters_.size(), true), left_(clusters_.size()) {
    added_.assign(clusters_.size(), std::vector<double>(clusters_.size(), INFINITY));
    for (std::size_t a = 0; a < clusters_.size(); ++a) fill_row(a, a + 1);
  }

  double air() const {
    double sum = 0;
    for (std::size_t i = 0; i < clusters_.size(); ++i) sum += alive_[i] ? clusters_[i].air : 0;
    return sum;
  }

  /// `unit`: the volume of the solid, so much less as the air is counted short.
  std::vector<Cluster> run(const DecompositionLimits& limits, double unit) {
    double sum = air();
    while (left_ > 1) {
      const auto [a, b] = cheapest();
      double allowed = left_ > limits.aim_pieces ? limits.max_air : limits.aim_air;
      if (left_ > limits.max_pieces) allowed = INFINITY;
      if (sum + added_[a][b] > allowed * unit) break;
      sum += added_[a][b];
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
      added_[std::min(a, b)][std::max(a, b)] =
          merged(clusters_[a], clusters_[b]).air - clusters_[a].air - clusters_[b].air;
    }
  }
  std::pair<std::size_t, std::size_t> cheapest() const {
    std::pair<std::size_t, std::size_t> best{0, 0};
    double least = INFINITY;
    for (std::size_t a = 0; a < clusters_.size(); ++a)
      for (std::size_t b = a + 1; b < clusters_.size(); ++b)
        if (alive_[a] && alive_[b] && added_[a][b] < least) least = added_[a][b], best = {a, b};
    return best;
  }

  std::vector<Cluster> clusters_;
  std::vector<bool> alive_;
  std::size_t left_;
  std::vector<std::vector<double>> added_;
};

struct Cut {
  std::array<SolidRegion, 2> sides;
  double score = INFINITY;
};

/// The plane that leaves the least air in the two hulls, and shares it evenly: the first cut of a ring leaves all of
/// it.
Cut best_cut(const SolidSampler& sampler, const SolidRegion& region) {
  Cut best;
  for (const SolidRegion::Plane& plane : sampler.candidates(region)) {
    std::array<SolidRegion, 2> sides = sampler.cut(region, plane);
    const double left = sampler.air_volume(sides[0]), right = sampler.air_volume(sides[1]);
    const double score = left + right + 0.1 * std::max(left, right);
    if (score < best.score) best = {std::move(sides), score};
  }
  return best;
}

/// Cuts the region with the most air, again and again.
std::vector<Cluster> cut_up(const TriangleMesh& mesh, const DecompositionLimits& limits, double volume) {
  const SolidSampler sampler(mesh, limits.cells);
  std::vector<SolidRegion> open = {sampler.whole()}, done;
  while (!open.empty() && open.size() + done.size() < 2 * limits.max_pieces) {
    const auto most = std::max_element(open.begin(), open.end(),
                                       [](const auto& a, const auto& b) { return a.air.size() < b.air.size(); });
    const SolidRegion region = std::move(*most);
    open.erase(most);
    Cut cut;
    if (sampler.air_volume(region) > limits.piece_air * volume) cut = best_cut(sampler, region);
    if (!std::isfinite(cut.score)) {
      done.push_back(region);
      continue;
    }
    for (SolidRegion& side : cut.sides)
      if (!side.hull.empty()) open.push_back(std::move(side));
  }
  done.insert(done.end(), open.begin(), open.end());
  std::vector<Cluster> clusters;
  for (const SolidRegion& region : done)
    if (!region.hull.empty())
      clusters.push_back({region.hull.vertices, enclosed_volume(region.hull), sampler.air_volume(region)});
  return clusters;
}

}  // namespace

std::vector<TriangleMesh> convex_decomposition(const TriangleMesh& mesh, const DecompositionLimits& given) {
  DecompositionLimits limits = given;
  // What is nothing on a part of 100 mm is much on one of 5.
  limits.tolerance = std::min(limits.tolerance, kSmallTolerance * bounding_box(mesh).diagonal().norm());
  const TriangleMesh whole = piece_of(mesh.vertices, limits);
  if (whole.empty()) return {};
  const double volume = std::abs(enclosed_volume(mesh));
  if (enclosed_volume(convex_hull(mesh.vertices)) - volume < limits.convex_enough * volume) return {whole};
  const Merger regions(cut_up(mesh, limits, volume));
  std::vector<TriangleMesh> pieces;
  double unit = volume;
  // Air is counted short where hulls overlap: what the pieces really have more than the mesh corrects the second go.
  for (int go = 0; go < 2; ++go) {
    Merger merger = regions;
    pieces.clear();
    for (const Cluster& cluster : merger.run(limits, unit)) {
      TriangleMesh piece = piece_of(cluster.points, limits);
      if (!piece.empty()) pieces.push_back(std::move(piece));
    }
    if (pieces.empty()) return {whole};
    const double real = shape_error(mesh, pieces).volume_error() * volume;
    if (real <= limits.aim_air * volume || real <= merger.air()) break;
    unit = volume * merger.air() / real;
  }
  return pieces;
}

}  // namespace binpick

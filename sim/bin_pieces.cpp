#include "sim/bin_pieces.hpp"

#include <algorithm>
#include <optional>

#include "core/bin_mesh.hpp"
#include "core/convex_hull.hpp"
#include "core/error.hpp"
#include "core/mesh_repair.hpp"
#include "sim/kept_pieces.hpp"

namespace binpick {
namespace {

// Ways out of the room: down, through the sides, and through the corners.
const Eigen::Vector3d kWays[] = {{0, 0, -1}, {1, 0, 0},  {-1, 0, 0},  {0, 1, 0}, {0, -1, 0},
                                 {1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {-1, 1, 0}};
constexpr double kProbe = 0.004;     // m, grid of points that must stay free: no finer than any wall is thick
constexpr double kOffFloor = 0.002;  // m: points of the room start so far inside

/// A bin is a thin shell: air counts against its own small volume, and it may take more pieces than a part, since it is
/// there once.
DecompositionLimits shell_limits() {
  DecompositionLimits limits;
  limits.aim_pieces = 40, limits.max_pieces = 64;
  limits.cells = 72;
  return limits;
}

/// A convex solid by the planes of its faces.
class ConvexSolid {
 public:
  explicit ConvexSolid(const TriangleMesh& hull) {
    for (const auto& t : hull.triangles) {
      const Eigen::Vector3d& a = hull.vertices[t[0]];
      const Eigen::Vector3d normal = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a).stableNormalized();
      planes_.push_back({normal, normal.dot(a)});
      box_.extend(a).extend(hull.vertices[t[1]]).extend(hull.vertices[t[2]]);
    }
  }
  bool holds(const Eigen::Vector3d& p) const {
    return box_.contains(p) && std::all_of(planes_.begin(), planes_.end(),
                                           [&](const auto& plane) { return plane.first.dot(p) <= plane.second; });
  }

 private:
  std::vector<std::pair<Eigen::Vector3d, double>> planes_;
  Eigen::AlignedBox3d box_;
};

std::vector<Eigen::Vector3d> room_of(const BinSpec& bin, const std::vector<TriangleMesh>& pieces_B) {
  std::vector<ConvexSolid> solids(pieces_B.begin(), pieces_B.end());
  std::vector<Eigen::Vector3d> room;
  for (double z = kOffFloor; z < bin.inner_size.z(); z += kProbe) {
    const Eigen::Vector2d half = bin.half_at(z) - Eigen::Vector2d::Constant(kOffFloor);
    for (double x = -half.x(); x <= half.x(); x += kProbe)
      for (double y = -half.y(); y <= half.y(); y += kProbe) {
        const Eigen::Vector3d p(x, y, z);
        if (std::none_of(solids.begin(), solids.end(), [&](const ConvexSolid& s) { return s.holds(p); }))
          room.push_back(p);
      }
  }
  return room;
}

TriangleMesh swept(const TriangleMesh& piece, const Eigen::Vector3d& way) {
  std::vector<Eigen::Vector3d> points = piece.vertices;
  for (const Eigen::Vector3d& v : piece.vertices) points.push_back(v + way);
  return convex_hull(points);
}

}  // namespace

void prepare_bin(BinSpec& bin) {
  bin.load();
  if (!bin.solid || bin.pieces_B) return;
  std::vector<TriangleMesh> pieces =
      kept_decomposition(bin.solid->mesh_B, shell_limits(), DiskCache::from_environment());
  if (pieces.empty()) throw AssetError(bin.mesh + ": the mesh spans no volume that could collide");
  bin.pieces_B = std::make_shared<const std::vector<TriangleMesh>>(std::move(pieces));
}

std::vector<TriangleMesh> thickened(const std::vector<TriangleMesh>& pieces_B, const BinSpec& bin, double thickness) {
  const std::vector<Eigen::Vector3d> room = room_of(bin, pieces_B);
  const auto free = [&](const TriangleMesh& hull) {
    const ConvexSolid solid(hull);
    return std::none_of(room.begin(), room.end(), [&](const Eigen::Vector3d& p) { return solid.holds(p); });
  };
  std::vector<TriangleMesh> result;
  for (const TriangleMesh& piece : pieces_B) {
    result.push_back(piece);
    for (const Eigen::Vector3d& way : kWays) {
      TriangleMesh hull = swept(piece, thickness * way.normalized());
      // The way it is broadest across: a wall could be swept down as well, and would be as thin as before.
      if (hull.empty() || signed_volume(hull) <= signed_volume(result.back()) || !free(hull)) continue;
      result.back() = std::move(hull);
    }
  }
  return result;
}

}  // namespace binpick

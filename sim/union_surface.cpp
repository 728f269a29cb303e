// Faces of convex pieces with everything cut away that other pieces cover.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/mesh_properties.hpp"
#include "sim/shape_error.hpp"

namespace binpick {
namespace {

using Polygon = std::vector<Eigen::Vector3d>;

struct Plane {
  Eigen::Vector3d normal;
  double offset;  ///< inside is normal.p <= offset
};

struct Piece {
  std::vector<Plane> planes;
  Eigen::AlignedBox3d box;
};

/// The piece, grown by `margin`.
Piece piece_of(const TriangleMesh& hull, double margin) {
  Piece piece;
  piece.box = bounding_box(hull);
  const double size = piece.box.diagonal().norm();
  piece.box = Eigen::AlignedBox3d(piece.box.min().array() - margin, piece.box.max().array() + margin);
  for (const auto& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[t[0]];
    const Eigen::Vector3d n = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a).stableNormalized();
    const double offset = n.dot(a) + margin;
    const auto same = [&](const Plane& p) {
      return (p.normal - n).norm() < 1e-9 && std::abs(p.offset - offset) < 1e-9 * size;
    };
    if (n.norm() > 0.5 && std::none_of(piece.planes.begin(), piece.planes.end(), same))
      piece.planes.push_back({n, offset});
  }
  return piece;
}

/// The polygon in front of a plane and behind it (Sutherland-Hodgman, twice); either may be empty.
std::pair<Polygon, Polygon> split(const Polygon& polygon, const Plane& plane) {
  std::pair<Polygon, Polygon> sides;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = plane.normal.dot(a) - plane.offset, db = plane.normal.dot(b) - plane.offset;
    (da > 0 ? sides.first : sides.second).push_back(a);
    if ((da > 0) == (db > 0)) continue;
    const Eigen::Vector3d p = a + da / (da - db) * (b - a);
    sides.first.push_back(p);
    sides.second.push_back(p);
  }
  return sides;
}

/// Appends what of `polygon` is not covered by `piece` when moved by `shift`.
void add_uncovered(const Polygon& polygon, const Piece& piece, const Eigen::Vector3d& shift,
                   std::vector<Polygon>& result) {
  std::vector<Polygon> outside;
  Polygon rest = polygon;
  for (const Plane& plane : piece.planes) {
    auto [front, behind] = split(rest, {plane.normal, plane.offset - plane.normal.dot(shift)});
    if (front.size() > 2) outside.push_back(std::move(front));
    rest = std::move(behind);
    if (rest.size() < 3) {  // not covered at all: kept whole
      result.push_back(polygon);
      return;
    }
  }
  result.insert(result.end(), outside.begin(), outside.end());
}

}  // namespace

TriangleMesh union_surface(const std::vector<TriangleMesh>& pieces, double touch) {
  std::vector<Piece> solids;
  // Grown by half of what faces are moved, so that three pieces that meet in a line leave no crevice.
  for (const TriangleMesh& piece : pieces) solids.push_back(piece_of(piece, touch / 2));
  TriangleMesh surface;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (const auto& t : pieces[i].triangles) {
      const Polygon face = {pieces[i].vertices[t[0]], pieces[i].vertices[t[1]], pieces[i].vertices[t[2]]};
      const Eigen::Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]).stableNormalized();
      const Eigen::Vector3d shift = touch * normal;
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& p : face) box.extend(p + shift);
      std::vector<Polygon> open = {face}, next;
      for (std::size_t j = 0; j < solids.size(); ++j) {
        if (j == i || !solids[j].box.intersects(box)) continue;
        next.clear();
        for (const Polygon& polygon : open) add_uncovered(polygon, solids[j], shift, next);
        std::swap(open, next);
      }
      for (const Polygon& polygon : open) {
        const auto first = static_cast<std::uint32_t>(surface.vertices.size());
        surface.vertices.insert(surface.vertices.end(), polygon.begin(), polygon.end());
        for (std::uint32_t k = 2; k < polygon.size(); ++k)
          surface.triangles.push_back({first, first + k - 1, first + k});
      }
    }
  return surface;
}

}  // namespace binpick

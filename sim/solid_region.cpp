#include "sim/solid_region.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/convex_hull.hpp"

namespace binpick {
namespace {

using Plane = SolidRegion::Plane;
using Polygon = SolidRegion::Polygon;

/// The part of a polygon behind a plane (Sutherland-Hodgman).
Polygon clipped(const Polygon& polygon, const Plane& plane) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = plane.normal.dot(a) - plane.offset, db = plane.normal.dot(b) - plane.offset;
    if (da <= 0) result.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) result.push_back(a + da / (da - db) * (b - a));
  }
  return result;
}

/// Points inside a hull, by its planes, or at most `slack` outside of one: a sample in the cutting plane is not lost.
std::vector<Eigen::Vector3d> points_inside(const TriangleMesh& hull, const std::vector<Eigen::Vector3d>& points,
                                           double slack) {
  std::vector<Plane> planes;
  for (const auto& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[t[0]];
    const Eigen::Vector3d n = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a);
    planes.push_back({n, n.dot(a) + slack * n.norm()});
  }
  std::vector<Eigen::Vector3d> result;
  for (const Eigen::Vector3d& p : points) {
    const auto outside = [&](const Plane& plane) { return plane.normal.dot(p) > plane.offset; };
    if (std::none_of(planes.begin(), planes.end(), outside)) result.push_back(p);
  }
  return result;
}

}  // namespace

SolidSampler::SolidSampler(const TriangleMesh& mesh, int cells) : mesh_(mesh), query_(mesh) {
  const Eigen::Vector3d size = bounding_box(mesh).sizes();
  cell_ = size.maxCoeff() / cells;
  cell_volume_ = cell_ * cell_ * cell_;
  // Regions stay a hair away from the cutting plane: what only touches it belongs to the other side.
  gap_ = 1e-5 * size.maxCoeff();
}

bool SolidSampler::inside(const Eigen::Vector3d& p) const {
  // Parity along a skew direction, so that no ray runs in a face of a machined part.
  const Eigen::Vector3d direction = Eigen::Vector3d(0.2137, 0.3391, 0.9162).normalized();
  Eigen::Vector3d origin = p;
  bool odd = false;
  for (int crossings = 0; crossings < 256; ++crossings) {
    const auto hit = query_.ray(origin, direction, 1e3);
    if (!hit) break;
    odd = !odd;
    origin = hit->point + 1e-3 * gap_ * direction;
  }
  return odd;
}

SolidRegion SolidSampler::whole() const {
  SolidRegion region;
  for (const auto& t : mesh_.triangles)
    region.surface.push_back({mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]});
  region.hull = convex_hull(mesh_.vertices);
  if (region.hull.empty()) return region;
  std::vector<Eigen::Vector3d> grid;
  const Eigen::AlignedBox3d box = bounding_box(mesh_);
  const Eigen::Vector3i n = (box.sizes() / cell_).array().ceil().cast<int>().max(1);
  const Eigen::Vector3d step = box.sizes().cwiseQuotient(n.cast<double>());
  for (int z = 0; z < n.z(); ++z)
    for (int y = 0; y < n.y(); ++y)
      for (int x = 0; x < n.x(); ++x)
        grid.push_back(box.min() + step.cwiseProduct(Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5)));
  for (const Eigen::Vector3d& p : points_inside(region.hull, grid, 0))
    if (!inside(p)) region.air.push_back(p);
  return region;
}

/// Where three of the cutting planes meet inside the solid: corners that the surface does not have.
std::vector<Eigen::Vector3d> SolidSampler::inner_corners(const SolidRegion& region) const {
  std::vector<Eigen::Vector3d> corners;
  const auto& planes = region.planes;
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = i + 1; j < planes.size(); ++j)
      for (std::size_t k = j + 1; k < planes.size(); ++k) {
        Eigen::Matrix3d A;
        A << planes[i].normal.transpose(), planes[j].normal.transpose(), planes[k].normal.transpose();
        if (std::abs(A.determinant()) < 1e-6) continue;
        const Eigen::Vector3d p = A.inverse() * Eigen::Vector3d(planes[i].offset, planes[j].offset, planes[k].offset);
        const auto behind_plane = [&](const Plane& plane) { return plane.normal.dot(p) <= plane.offset + 0.1 * gap_; };
        if (std::all_of(planes.begin(), planes.end(), behind_plane) && inside(p)) corners.push_back(p);
      }
  return corners;
}

SolidRegion SolidSampler::behind(const SolidRegion& parent, const Plane& plane) const {
  SolidRegion region;
  region.planes = parent.planes;
  region.planes.push_back(plane);
  std::vector<Eigen::Vector3d> points = inner_corners(region);
  for (const Polygon& polygon : parent.surface) {
    Polygon rest = clipped(polygon, plane);
    if (rest.empty()) continue;
    points.insert(points.end(), rest.begin(), rest.end());
    region.surface.push_back(std::move(rest));
  }
  region.hull = convex_hull(points);
  if (!region.hull.empty()) region.air = points_inside(region.hull, parent.air, 2 * gap_);
  return region;
}

std::array<SolidRegion, 2> SolidSampler::cut(const SolidRegion& region, const Plane& plane) const {
  return {behind(region, {plane.normal, plane.offset - gap_}), behind(region, {-plane.normal, -plane.offset - gap_})};
}

std::vector<Plane> SolidSampler::candidates(const SolidRegion& region) const {
  std::vector<Plane> result;
  for (int axis = 0; axis < 3; ++axis) add_candidates(region, Eigen::Vector3d::Unit(axis), result);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      Eigen::Vector3d normal = Eigen::Vector3d::Unit((axis + 1) % 3) + sign * Eigen::Vector3d::Unit((axis + 2) % 3);
      add_candidates(region, normal.normalized(), result);
    }
  return result;
}

void SolidSampler::add_candidates(const SolidRegion& region, const Eigen::Vector3d& normal,
                                  std::vector<Plane>& result) const {
  double low = 1e9, high = -1e9;
  for (const Eigen::Vector3d& v : region.hull.vertices) {
    low = std::min(low, normal.dot(v));
    high = std::max(high, normal.dot(v));
  }
  if (high - low < 4 * cell_) return;
  std::map<long, double> area;  // of flat faces across the normal, by place on a fine grid
  for (const Polygon& polygon : region.surface) {
    const double at = normal.dot(polygon.front());
    const auto off = [&](const Eigen::Vector3d& p) { return std::abs(normal.dot(p) - at) > gap_; };
    if (at < low + 3 * gap_ || at > high - 3 * gap_ || std::any_of(polygon.begin(), polygon.end(), off)) continue;
    for (std::size_t i = 2; i < polygon.size(); ++i)
      area[std::lround(at / gap_)] += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]).norm() / 2;
  }
  std::vector<std::pair<double, long>> faces;
  for (const auto& [place, size] : area) faces.emplace_back(-size, place);
  std::sort(faces.begin(), faces.end());
  constexpr std::size_t kFaces = 6;
  constexpr int kSpread = 6;
  for (std::size_t i = 0; i < std::min(kFaces, faces.size()); ++i)
    result.push_back({normal, static_cast<double>(faces[i].second) * gap_});
  for (int i = 1; i < kSpread; ++i) result.push_back({normal, low + (high - low) * i / kSpread});
}

}  // namespace binpick

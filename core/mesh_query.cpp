// MeshQuery: rays and closest points over a BoxTree. Rays use the watertight test of Woop, Benthin and Wald (2013) in
// double precision: a ray through a shared edge or corner never slips between two triangles. Ties go to the lower
// triangle number, so the answer does not depend on the shape of the tree.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/box_tree.hpp"
#include "core/check.hpp"
#include "core/mesh_properties.hpp"

namespace binpick {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSlack = 8 * std::numeric_limits<double>::epsilon();  ///< rounding of the slab test

struct Corners {
  Eigen::Vector3d a, b, c;
};

/// A ray prepared for the watertight test: axes permuted and sheared so that it runs along +z.
struct PreparedRay {
  Eigen::Vector3d origin, inverse;
  Eigen::Index x, y, z;
  double shear_x, shear_y, shear_z;

  PreparedRay(const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
      : origin(from), inverse(direction.cwiseInverse()) {
    direction.cwiseAbs().maxCoeff(&z);
    x = (z + 1) % 3;
    y = (z + 2) % 3;
    if (direction[z] < 0) std::swap(x, y);
    shear_x = direction[x] / direction[z];
    shear_y = direction[y] / direction[z];
    shear_z = 1 / direction[z];
  }

  /// Parameter at which the ray enters the box, or infinity; never later than the first hit inside.
  double enter(const Eigen::AlignedBox3d& box, double max_t) const {
    double near = 0;
    double far = max_t;
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (std::isinf(inverse[k])) {  // parallel to this slab: 0 * infinity must not decide
        if (origin[k] < box.min()[k] || origin[k] > box.max()[k]) return kInfinity;
        continue;
      }
      const double t0 = (box.min()[k] - origin[k]) * inverse[k];
      const double t1 = (box.max()[k] - origin[k]) * inverse[k];
      near = std::max(near, std::min(t0, t1) * (1 - kSlack));
      far = std::min(far, std::max(t0, t1) * (1 + kSlack));
    }
    return near <= far ? near : kInfinity;
  }

  /// Parameter of the hit on either side of the triangle, or infinity.
  double hit(const Corners& triangle) const {
    const Eigen::Vector3d a = triangle.a - origin;
    const Eigen::Vector3d b = triangle.b - origin;
    const Eigen::Vector3d c = triangle.c - origin;
    const double ax = a[x] - shear_x * a[z], ay = a[y] - shear_y * a[z];
    const double bx = b[x] - shear_x * b[z], by = b[y] - shear_y * b[z];
    const double cx = c[x] - shear_x * c[z], cy = c[y] - shear_y * c[z];
    const double u = cx * by - cy * bx;
    const double v = ax * cy - ay * cx;
    const double w = bx * ay - by * ax;
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return kInfinity;
    const double det = u + v + w;
    if (det == 0) return kInfinity;
    const double t = shear_z * (u * a[z] + v * b[z] + w * c[z]) / det;
    return t >= 0 ? t : kInfinity;  // NaN fails too
  }
};

/// Closest point of triangle abc to p, by the regions of its plane.
Eigen::Vector3d closest_on_triangle(const Corners& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d ab = t.b - t.a;
  const Eigen::Vector3d ac = t.c - t.a;
  const Eigen::Vector3d bc = t.c - t.b;
  const Eigen::Vector3d normal = ab.cross(ac);
  const double area = normal.squaredNorm();
  if (area > 0) {
    // Barycentric coordinates of the foot point; all positive: it lies inside.
    const Eigen::Vector3d ap = p - t.a;
    const double gamma = ab.cross(ap).dot(normal) / area;
    const double beta = ap.cross(ac).dot(normal) / area;
    if (gamma >= 0 && beta >= 0 && gamma + beta <= 1) return p - normal * (ap.dot(normal) / area);
  }
  const auto on_segment = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& edge) -> Eigen::Vector3d {
    const double length = edge.squaredNorm();
    const double s = length > 0 ? std::clamp((p - from).dot(edge) / length, 0.0, 1.0) : 0.0;
    return from + s * edge;
  };
  Eigen::Vector3d best = on_segment(t.a, ab);
  for (const Eigen::Vector3d& other : {on_segment(t.b, bc), on_segment(t.a, ac)}) {
    if ((other - p).squaredNorm() < (best - p).squaredNorm()) best = other;
  }
  return best;
}

/// What a search has found so far: the nearest entry of the leaves, the lower triangle number on a tie.
struct Nearest {
  double measure;  ///< ray parameter or squared distance; bounds the search
  std::uint32_t triangle = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t entry = 0;

  void offer(double value, std::uint32_t number, std::uint32_t at) {
    if (value < measure || (value == measure && number < triangle)) *this = {value, number, at};
  }
  bool found() const { return triangle != std::numeric_limits<std::uint32_t>::max(); }
};

/// Visits the leaves in the order of `bound_of(box)`, skipping boxes whose bound exceeds what was found.
template <class BoundOf, class VisitEntry>
void search(const BoxTree& tree, Nearest& nearest, const BoundOf& bound_of, const VisitEntry& visit) {
  if (tree.nodes.empty()) return;
  std::array<std::pair<std::uint32_t, double>, BoxTree::kMaxDepth> stack;
  std::size_t top = 0;
  stack[top++] = {0, bound_of(tree.nodes[0].box)};
  while (top > 0) {
    const auto [index, bound] = stack[--top];
    if (!(bound <= nearest.measure) || bound == kInfinity) continue;
    const BoxTree::Node& node = tree.nodes[index];
    if (node.count > 0) {
      for (std::uint32_t i = node.begin; i < node.begin + node.count; ++i) visit(i);
      continue;
    }
    std::pair<std::uint32_t, double> near{index + 1, bound_of(tree.nodes[index + 1].box)};
    std::pair<std::uint32_t, double> far{node.begin, bound_of(tree.nodes[node.begin].box)};
    if (far.second < near.second) std::swap(near, far);
    stack[top++] = far;
    stack[top++] = near;
  }
}

}  // namespace

struct MeshQuery::Impl {
  BoxTree tree;
  std::vector<Corners> corners;          ///< in the order of the tree's items
  std::vector<Eigen::Vector3d> normals;  ///< the same
};

MeshQuery::MeshQuery(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>()) {
  std::vector<Eigen::AlignedBox3d> boxes(mesh.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      BP_CHECK(corner < mesh.vertices.size());
      BP_CHECK(mesh.vertices[corner].allFinite());
      boxes[i].extend(mesh.vertices[corner]);
    }
  }
  impl_->tree = build_box_tree(boxes);
  for (const std::uint32_t item : impl_->tree.items) {
    const auto& t = mesh.triangles[item];
    const Corners c = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    const Eigen::Vector3d normal = (c.b - c.a).cross(c.c - c.a);
    impl_->corners.push_back(c);
    impl_->normals.push_back(normal.squaredNorm() > 0 ? Eigen::Vector3d(normal.normalized())
                                                      : Eigen::Vector3d::UnitZ());
  }
}

MeshQuery::~MeshQuery() = default;
MeshQuery::MeshQuery(MeshQuery&&) noexcept = default;
MeshQuery& MeshQuery::operator=(MeshQuery&&) noexcept = default;

std::optional<MeshQuery::Hit> MeshQuery::ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                             double max_distance) const {
  if (!origin.allFinite() || !direction.allFinite() || direction.isZero(0) || !(max_distance >= 0)) return {};
  const PreparedRay ray(origin, direction);
  Nearest nearest{max_distance};
  search(
      impl_->tree, nearest, [&](const auto& box) { return ray.enter(box, nearest.measure); },
      [&](std::uint32_t i) {
        const double t = ray.hit(impl_->corners[i]);
        if (t < kInfinity) nearest.offer(t, impl_->tree.items[i], i);
      });
  if (!nearest.found()) return {};
  return Hit{nearest.measure, origin + nearest.measure * direction, impl_->normals[nearest.entry], nearest.triangle};
}

std::optional<MeshQuery::Hit> MeshQuery::closest(const Eigen::Vector3d& point, double max_distance) const {
  if (!point.allFinite() || !(max_distance >= 0)) return {};
  Nearest nearest{max_distance * max_distance};
  Eigen::Vector3d best = point;
  search(
      impl_->tree, nearest, [&](const auto& box) { return box.squaredExteriorDistance(point); },
      [&](std::uint32_t i) {
        const Eigen::Vector3d candidate = closest_on_triangle(impl_->corners[i], point);
        const std::uint32_t before = nearest.triangle;
        nearest.offer((candidate - point).squaredNorm(), impl_->tree.items[i], i);
        if (nearest.triangle != before) best = candidate;
      });
  if (!nearest.found()) return {};
  return Hit{std::sqrt(nearest.measure), best, impl_->normals[nearest.entry], nearest.triangle};
}

}  // namespace binpick

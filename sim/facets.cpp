#include "sim/facets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/mesh_properties.hpp"
#include "core/parallel.hpp"

namespace binpick {
namespace {

constexpr double kGrazing = 0.05;  // sine of the angle below which a plane is not trusted beyond its triangle
constexpr int kRowsAtOnce = 16;

double signed_volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]));
  return sum / 6;
}

std::array<Eigen::Vector3d, 8> corners_C(const FacetView& view, std::size_t item) {
  const Eigen::AlignedBox3d& box = view.facets[item]->box_O;
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i)
    corners[static_cast<std::size_t>(i)] =
        view.X_CO[item] * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
  return corners;
}

// The plane of one triangle in C, turned to the camera.
struct PlaneC {
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  double offset = 0;
};

PlaneC plane_in_camera(const FacetView& view, const FacetId& id) {
  const auto item = static_cast<std::size_t>(id.item);
  const Eigen::Vector4d& plane = view.facets[item]->planes_O[static_cast<std::size_t>(id.triangle)];
  const Pose& X_CO = view.X_CO[item];
  PlaneC out;
  out.n = X_CO.linear() * plane.head<3>();
  out.offset = plane[3] + out.n.dot(X_CO.translation());
  if (out.offset > 0) out.n = -out.n, out.offset = -out.offset;  // the camera at 0 lies on the side of n
  return out;
}

// Of a triangle seen edge-on the plane says little beside it: depth stays within that of the corners.
double within_corners(const FacetView& view, const FacetId& id, double z) {
  const auto item = static_cast<std::size_t>(id.item);
  const TriangleMesh& mesh = *view.scene.items[item].mesh_O;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const std::uint32_t corner : mesh.triangles[static_cast<std::size_t>(id.triangle)]) {
    const double corner_z = (view.X_CO[item] * mesh.vertices[corner]).z();
    low = std::min(low, corner_z);
    high = std::max(high, corner_z);
  }
  return z > low ? std::min(z, high) : low;  // low also for NaN
}

void fill_row(const FacetView& view, const Image<FacetId>& seen, int v, ExactFrame& frame) {
  FacetId last;
  PlaneC plane;
  for (int u = 0; u < view.camera.width; ++u) {
    const FacetId id = seen(u, v);
    if (id.item < 0) {
      frame.depth(u, v) = std::numeric_limits<float>::quiet_NaN();
      frame.ids(u, v) = kIdNothing;
      continue;
    }
    if (id.item != last.item || id.triangle != last.triangle) plane = plane_in_camera(view, id), last = id;
    const Eigen::Vector3d ray = view.camera.ray(u, v);
    const double facing = plane.n.dot(ray);
    double z = plane.offset / facing;
    if (!(facing * facing > kGrazing * kGrazing * ray.squaredNorm())) z = within_corners(view, id, z);
    frame.depth(u, v) = static_cast<float>(std::clamp(z, view.near, view.far));
    frame.ids(u, v) = view.scene.items[static_cast<std::size_t>(id.item)].id;
    frame.normals_C(u, v) = plane.n.cast<float>();
  }
}

}  // namespace

MeshFacets::MeshFacets(const TriangleMesh& mesh_O) {
  planes_O.reserve(mesh_O.triangles.size());
  for (const auto& [a, b, c] : mesh_O.triangles) {
    const Eigen::Vector3d& p = mesh_O.vertices[a];
    const Eigen::Vector3d n = (mesh_O.vertices[b] - p).cross(mesh_O.vertices[c] - p).stableNormalized();
    planes_O.push_back({n.x(), n.y(), n.z(), n.dot(p)});
  }
  box_O = bounding_box(mesh_O);
  closed = is_closed(mesh_O) && signed_volume(mesh_O) > 0;
}

bool may_be_seen(const FacetView& view, std::size_t item) {
  const PinholeCamera& c = view.camera;
  int left = 0, right = 0, above = 0, below = 0, before = 0, behind = 0;
  for (const Eigen::Vector3d& p : corners_C(view, item)) {
    left += c.fx * p.x() + (c.cx + 0.5) * p.z() < 0;
    right += c.fx * p.x() + (c.cx + 0.5 - c.width) * p.z() > 0;
    above += c.fy * p.y() + (c.cy + 0.5) * p.z() < 0;
    below += c.fy * p.y() + (c.cy + 0.5 - c.height) * p.z() > 0;
    before += p.z() < view.near;
    behind += p.z() > view.far;
  }
  return std::max({left, right, above, below, before, behind}) < 8;
}

bool hides_its_back(const FacetView& view, std::size_t item) {
  if (!view.facets[item]->closed) return false;
  for (const Eigen::Vector3d& p : corners_C(view, item))
    if (p.z() <= view.near) return false;
  return true;
}

ExactFrame frame_of(const FacetView& view, const Image<FacetId>& seen) {
  const int width = view.camera.width, height = view.camera.height;
  ExactFrame frame;
  frame.depth = Image<float>(width, height);
  frame.ids = Image<std::int32_t>(width, height);
  frame.normals_C = Image<Eigen::Vector3f>(width, height, Eigen::Vector3f::Zero());
  frame.materials = MaterialTable(view.scene);
  const auto blocks = static_cast<std::size_t>((height + kRowsAtOnce - 1) / kRowsAtOnce);
  parallel_for(blocks, view.threads, [&](std::size_t block) {
    const int first = static_cast<int>(block) * kRowsAtOnce;
    for (int v = first; v < std::min(first + kRowsAtOnce, height); ++v) fill_row(view, seen, v, frame);
  });
  return frame;
}

}  // namespace binpick

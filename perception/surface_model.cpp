#include "perception/surface_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/mesh_properties.hpp"
#include "core/parallel.hpp"
#include "core/sample_surface.hpp"
#include "perception/parallel_rays.hpp"

namespace binpick {
namespace {

/// Even directions on the sphere (golden spiral).
std::vector<Eigen::Vector3f> sphere_directions(int count) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Eigen::Vector3f> out;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
    out.push_back(Eigen::Vector3d(r * std::cos(golden * i), r * std::sin(golden * i), z).cast<float>());
  }
  return out;
}

constexpr int kThreads = 2;  // for the rays; the masks are put together by view

/// The views from which every sample can be seen.
std::vector<SurfaceModel::ViewMask> view_masks(const TriangleMesh& mesh_P, const PointCloud& samples_P, double lift,
                                               const std::vector<Eigen::Vector3f>& views) {
  std::vector<std::vector<std::uint8_t>> seen(views.size(), std::vector<std::uint8_t>(samples_P.size(), 0));
  parallel_for(views.size(), kThreads, [&](std::size_t v) {
    const Eigen::Vector3d direction = views[v].cast<double>().normalized();
    ParallelRays rays(mesh_P, direction);
    for (std::size_t i = 0; i < samples_P.size(); ++i) {
      const Eigen::Vector3d& n = samples_P.normals[i];
      seen[v][i] = n.dot(direction) > 0.02 && !rays.blocked(samples_P.points[i] + lift * n);
    }
  });
  std::vector<SurfaceModel::ViewMask> masks(samples_P.size(), 0);
  for (std::size_t v = 0; v < views.size(); ++v)
    for (std::size_t i = 0; i < samples_P.size(); ++i) masks[i] |= SurfaceModel::ViewMask{seen[v][i]} << v;
  return masks;
}

}  // namespace

SurfaceModel::SurfaceModel(const TriangleMesh& mesh_P, double spacing, double reach)
    : views_(sphere_directions(kViews)), seen_(kViews), spacing_(static_cast<float>(spacing)) {
  const PointCloud cloud = sample_surface(mesh_P, spacing, Seed{0x73757266ull});
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Seed{0x73757267ull}.rng().shuffle(order);
  box_ = bounding_box(mesh_P).cast<float>();
  const std::vector<ViewMask> masks = view_masks(mesh_P, cloud, 1e-3 * spacing, views_);
  for (const std::size_t i : order) {
    if (masks[i] == 0) continue;
    points_.push_back(cloud.points[i].cast<float>());
    normals_.push_back(cloud.normals[i].cast<float>());
    masks_.push_back(masks[i]);
  }
  for (const Eigen::Vector3f& p : points_) radius_ = std::max(radius_, (p - center()).norm() + spacing_);
  build_shell(mesh_P);
  build_field(static_cast<float>(reach));
  list_views();
  face_shell();
  pack();
}

void SurfaceModel::write(ByteWriter& out) const {
  out.add(points_).add(normals_).add(masks_).add(shell_.vertices).add(shell_.triangles);
  out.add(box_.min()).add(box_.max()).add(radius_).add(spacing_).add(low_).add(size_).add(field_);
}

SurfaceModel::SurfaceModel(ByteReader& in) : views_(sphere_directions(kViews)), seen_(kViews) {
  in.get(points_).get(normals_).get(masks_).get(shell_.vertices).get(shell_.triangles);
  in.get(box_.min()).get(box_.max()).get(radius_).get(spacing_).get(low_).get(size_).get(field_);
  if (!in.ok() || !consistent()) {
    in.fail();
    *this = SurfaceModel();
    return;
  }
  inverse_cell_ = 1 / spacing_;
  limit_ = size_.cast<float>().array();
  list_views();
  face_shell();
  pack();
}

/// Every look-up ends inside the model.
bool SurfaceModel::consistent() const {
  const std::size_t n = points_.size();
  constexpr int kMostCells = 1 << 10;  // along one axis: more than a part of any shape has
  if (normals_.size() != n || masks_.size() != n || n > std::numeric_limits<std::int32_t>::max()) return false;
  const auto finite = [](const Eigen::Vector3f& p) { return p.allFinite(); };
  if (!std::all_of(points_.begin(), points_.end(), finite) || !box_.sizes().allFinite() || !low_.allFinite())
    return false;
  if (!(spacing_ > 0) || !std::isfinite(spacing_ + radius_) || (size_.array() < 1).any() ||
      (size_.array() > kMostCells).any())
    return false;
  if (field_.size() != 2 * static_cast<std::size_t>(size_.x()) * size_.y() * size_.z()) return false;
  const auto known = [&](std::int32_t i) { return i >= -1 && i < static_cast<std::int32_t>(n); };
  return std::all_of(field_.begin(), field_.end(), known) &&
         std::all_of(shell_.vertices.begin(), shell_.vertices.end(), [](const auto& p) { return p.allFinite(); }) &&
         std::all_of(shell_.triangles.begin(), shell_.triangles.end(), [&](const auto& t) {
           return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return v < shell_.vertices.size(); });
         });
}

void SurfaceModel::list_views() {
  for (std::size_t i = 0; i < points_.size(); ++i)
    for (int v = 0; v < kViews; ++v)
      if (visible(i, v)) seen_[v].push_back(static_cast<std::uint32_t>(i));
}

/// The same once more, in the order in which the kernels read it.
void SurfaceModel::pack() {
  constexpr std::size_t kLanes = 8;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    SurfacePoint& point = packed_.emplace_back();
    for (int k = 0; k < 3; ++k) {
      point.p[k] = points_[i][k];
      point.n[k] = normals_[i][k];
    }
    point.views = masks_[i];
  }
  for (const std::vector<std::uint32_t>& seen : seen_) {
    const std::size_t count = (seen.size() + kLanes - 1) / kLanes * kLanes;
    PackedView& view = packed_views_.emplace_back();
    view.count = static_cast<int>(count);
    view.numbers.assign(6 * count, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < seen.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        view.numbers[k * count + i] = packed_[seen[i]].p[k];
        view.numbers[(k + 3) * count + i] = packed_[seen[i]].n[k];
      }
  }
}

ModelPointsView SurfaceModel::seen_points(int view, int most) const {
  const PackedView& packed = packed_views_[view];
  const float* x = packed.numbers.data();
  const std::size_t n = static_cast<std::size_t>(packed.count);
  return {x, x + n, x + 2 * n, x + 3 * n, x + 4 * n, x + 5 * n, std::min(packed.count, (most + 7) / 8 * 8)};
}

SurfaceGrid SurfaceModel::grid() const {
  SurfaceGrid out;
  out.cells = field_.data();
  out.points = packed_.data();
  out.inverse_cell = inverse_cell_;
  for (int k = 0; k < 3; ++k) {
    out.low[k] = low_[k];
    out.size[k] = size_[k];
  }
  return out;
}

int SurfaceModel::view_of(const Eigen::Vector3f& direction_P) const {
  int best = 0;
  float closest = -std::numeric_limits<float>::infinity();
  for (int v = 0; v < kViews; ++v) {
    const float c = views_[v].dot(direction_P);
    if (c > closest) {
      closest = c;
      best = v;
    }
  }
  return best;
}

/// A visible sample lies on the triangle or right beside it in its plane: no sliver leaves a hole, balls and raceways
/// go.
bool SurfaceModel::shows(const TriangleMesh& mesh_P, std::size_t triangle, const PointGrid& grid) const {
  const auto& t = mesh_P.triangles[triangle];
  const Eigen::Vector3f a = mesh_P.vertices[t[0]].cast<float>(), b = mesh_P.vertices[t[1]].cast<float>(),
                        c = mesh_P.vertices[t[2]].cast<float>();
  const Eigen::Vector3f center = (a + b + c) / 3, normal = (b - a).cross(c - a).normalized();
  const float reach = std::max({(a - center).norm(), (b - center).norm(), (c - center).norm()}) + 2 * spacing_;
  bool found = false;
  grid.within(center, reach, [&](std::uint32_t k) {
    found = found || (normals_[k].dot(normal) > 0.7f && std::abs(normal.dot(points_[k] - center)) < 0.5f * spacing_);
  });
  return found;
}

void SurfaceModel::build_shell(const TriangleMesh& mesh_P) {
  const PointGrid grid(points_, 3 * spacing_);
  std::vector<std::int32_t> index(mesh_P.vertices.size(), -1);
  for (std::size_t i = 0; i < mesh_P.triangles.size(); ++i) {
    if (!shows(mesh_P, i, grid)) continue;
    std::array<std::uint32_t, 3> t;
    for (int k = 0; k < 3; ++k) {
      std::int32_t& v = index[mesh_P.triangles[i][k]];
      if (v < 0) {
        v = static_cast<std::int32_t>(shell_.vertices.size());
        shell_.vertices.push_back(mesh_P.vertices[mesh_P.triangles[i][k]]);
      }
      t[k] = static_cast<std::uint32_t>(v);
    }
    shell_.triangles.push_back(t);
  }
}

void SurfaceModel::face_shell() {
  for (const auto& t : shell_.triangles) {
    const Eigen::Vector3d& a = shell_.vertices[t[0]];
    shell_normals_.push_back((shell_.vertices[t[1]] - a).cross(shell_.vertices[t[2]] - a));
  }
}

TriangleMesh SurfaceModel::shell_facing(const Eigen::Vector3d& eye_P) const {
  TriangleMesh facing;
  facing.vertices = shell_.vertices;
  for (std::size_t i = 0; i < shell_.triangles.size(); ++i)
    if (shell_normals_[i].dot(eye_P - shell_.vertices[shell_.triangles[i][0]]) > 0)
      facing.triangles.push_back(shell_.triangles[i]);
  return facing;
}

/// visit(cell, point, squared distance of the cell's centre) for every point and the cells around it, cells by their
/// point's number. Layers of cells are shared among threads: no two visit one cell.
template <class Visit>
void SurfaceModel::for_cells_within(float reach, Visit&& visit) const {
  const float cell = spacing_;
  const int steps = static_cast<int>(std::ceil(reach / cell));
  std::vector<float> middle_x(static_cast<std::size_t>(size_.x()));
  for (int x = 0; x < size_.x(); ++x) middle_x[x] = low_.x() + cell * (static_cast<float>(x) + 0.5f);
  const auto squared = [](float d) { return d * d; };
  const auto layers = [&](int first, int last) {
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const Eigen::Array3i c = ((points_[k] - low_).array() * inverse_cell_).cast<int>();
      const Eigen::Array3i from = (c - steps).max(Eigen::Array3i(0, 0, first));
      const Eigen::Array3i to = (c + steps).min(Eigen::Array3i(size_.x() - 1, size_.y() - 1, last));
      for (int z = from.z(); z <= to.z(); ++z)
        for (int y = from.y(); y <= to.y(); ++y) {
          const float across = squared(low_.y() + cell * (static_cast<float>(y) + 0.5f) - points_[k].y()) +
                               squared(low_.z() + cell * (static_cast<float>(z) + 0.5f) - points_[k].z());
          if (!(across < reach * reach)) continue;
          const std::size_t row = (static_cast<std::size_t>(z) * size_.y() + y) * size_.x();
          for (int x = from.x(); x <= to.x(); ++x) visit(row + x, k, squared(middle_x[x] - points_[k].x()) + across);
        }
    }
  };
  const int shares = std::min(size_.z(), 2 * kThreads);
  parallel_for(static_cast<std::size_t>(shares), kThreads, [&](std::size_t s) {
    const int share = static_cast<int>(s);
    layers(size_.z() * share / shares, size_.z() * (share + 1) / shares - 1);
  });
}

void SurfaceModel::build_field(float reach) {
  const float cell = spacing_;
  inverse_cell_ = 1 / cell;
  low_ = box_.min().array() - reach;
  size_ =
      ((box_.max() - box_.min()).array() + 2 * reach).cwiseQuotient(Eigen::Array3f::Constant(cell)).ceil().cast<int>();
  size_.array() += 1;
  limit_ = size_.cast<float>().array();
  const auto count = static_cast<std::size_t>(size_.prod());
  field_.assign(2 * count, -1);
  std::vector<float> nearest(count, reach * reach);
  for_cells_within(reach, [&](std::size_t i, std::size_t k, float d) {
    if (d >= nearest[i]) return;
    nearest[i] = d;
    field_[2 * i] = static_cast<std::int32_t>(k);
  });
  // In a sheet the nearest point may lie on the side that no camera sees: the other side's is kept beside it.
  std::fill(nearest.begin(), nearest.end(), reach * reach);
  for_cells_within(reach, [&](std::size_t i, std::size_t k, float d) {
    if (d >= nearest[i] || normals_[k].dot(normals_[field_[2 * i]]) >= 0) return;
    nearest[i] = d;
    field_[2 * i + 1] = static_cast<std::int32_t>(k);
  });
}

}  // namespace binpick

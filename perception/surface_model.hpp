// The part as verification and refinement see it: a dense cloud of its outer surface with, for every point, the set of
// directions it can be seen from, and a grid that answers "which surface point is nearest" in one look-up. Also the
// mesh without its invisible insides, cheap to draw. Frame P, metres.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/byte_stream.hpp"
#include "core/mesh.hpp"
#include "perception/neighbours.hpp"
#include "perception/ray_kernel.hpp"
#include "perception/surface_kernel.hpp"

namespace binpick {

class SurfaceModel {
 public:
  static constexpr int kViews = 64;  ///< directions, even on the sphere: at most 15 degrees to the nearest
  using ViewMask = std::uint64_t;

  SurfaceModel() = default;
  /// Samples every `spacing` (m); the grid answers within `reach` (m) of the surface.
  SurfaceModel(const TriangleMesh& mesh_P, double spacing, double reach);
  /// What write() wrote; the reader has failed when it cannot be, and the model is empty.
  explicit SurfaceModel(ByteReader& in);
  void write(ByteWriter& out) const;

  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  const std::vector<Eigen::Vector3f>& normals() const { return normals_; }
  const TriangleMesh& shell() const { return shell_; }
  /// The shell's triangles that face an eye: the others are never seen, since the part is closed.
  TriangleMesh shell_facing(const Eigen::Vector3d& eye_P) const;
  const Eigen::AlignedBox3f& box() const { return box_; }
  Eigen::Vector3f center() const { return box_.center(); }
  float radius() const { return radius_; }  ///< of the sphere about center() that holds the part
  float spacing() const { return spacing_; }

  /// The view nearest to a direction (towards the eye).
  int view_of(const Eigen::Vector3f& direction_P) const;
  bool visible(std::size_t point, int view) const { return (masks_[point] >> view) & 1u; }
  ViewMask views_of(std::size_t point) const { return masks_[point]; }
  /// Indices of all points visible in a view; any stretch of the list is spread evenly over the surface.
  const std::vector<std::uint32_t>& seen_from(int view) const { return seen_[view]; }
  /// The first `most` of them (rounded up to eight) side by side, as the ray kernel reads them.
  ModelPointsView seen_points(int view, int most) const;
  /// Nearest point, normal and views as the surface kernel reads them.
  SurfaceGrid grid() const;

  /// Index of the nearest surface point, or -1 beyond the reach.
  int nearest(const Eigen::Vector3f& p_P) const {
    const Eigen::Array3f c = (p_P - low_).array() * inverse_cell_;
    if (!((c >= 0.0f).all() && (c < limit_).all())) return -1;
    const Eigen::Array3i i = c.cast<int>();
    return field_[2 * ((static_cast<std::size_t>(i.z()) * size_.y() + i.y()) * size_.x() + i.x())];
  }

 private:
  void build_shell(const TriangleMesh& mesh_P);
  bool shows(const TriangleMesh& mesh_P, std::size_t triangle, const PointGrid& grid) const;
  void build_field(float reach);
  bool consistent() const;
  template <class Visit>
  void for_cells_within(float reach, Visit&& visit) const;
  void list_views();
  void face_shell();
  void pack();
  std::vector<Eigen::Vector3f> points_, normals_;
  std::vector<ViewMask> masks_;
  std::vector<Eigen::Vector3f> views_;
  std::vector<std::vector<std::uint32_t>> seen_;
  TriangleMesh shell_;
  std::vector<Eigen::Vector3d> shell_normals_;  // not unit length
  Eigen::AlignedBox3f box_;
  float radius_ = 0, spacing_ = 0, inverse_cell_ = 1;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  Eigen::Array3f limit_ = Eigen::Array3f::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::int32_t> field_;  // for every cell the nearest point, and the nearest that faces the other way
  std::vector<SurfacePoint> packed_;
  struct PackedView {
    std::vector<float> numbers;  // six stretches: x y z, normal x y z
    int count = 0;               // of one stretch, a multiple of eight
  };
  std::vector<PackedView> packed_views_;
};

}  // namespace binpick

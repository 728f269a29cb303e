// How deep the true solids of a heap enter each other: the convex pieces that collide are an approximation, and a
// solver leaves some depth as well. Surface samples of one solid are looked up in the other.
#pragma once

#include <span>
#include <vector>

#include "core/bin_spec.hpp"
#include "core/mesh_properties.hpp"
#include "sim/world.hpp"

namespace binpick {

/// A solid prepared for it: its surface, corners and sharp edges as samples, and the solid to look into. Frame P.
class SolidProbe {
 public:
  /// `spacing` (m) of the samples on faces and along sharp edges; every vertex at a sharp edge is one more.
  SolidProbe(const TriangleMesh& closed_mesh_P, double spacing);

  /// Depth (m, >= 0) of the sample of `other` that lies deepest below this one's surface; at most kDeepest.
  double deepest_of(const SolidProbe& other, const Pose& X_PO) const;
  /// Depth (m, >= 0) of the sample of this solid that lies deepest in one of the boxes.
  double deepest_in(std::span<const Primitive> boxes_B, const Pose& X_BP) const;
  /// Both lie so far apart that they cannot touch.
  bool far_from(const SolidProbe& other, const Pose& X_PO) const;

  static constexpr double kDeepest = 5e-3;  ///< m: no surface is looked for farther away

 private:
  bool contains(const Eigen::Vector3d& p_P) const;

  MeshQuery query_;
  std::vector<Eigen::Vector3d> samples_P_;
  Eigen::AlignedBox3d box_P_;
  Eigen::Vector3d center_P_;  ///< of the box
  double radius_ = 0;         ///< m, of the sphere about it that holds the solid
};

/// Deepest point (m, 0 for those that only touch) of every pair of bodies that press on each other or enter each other,
/// pairs in order of the bodies, then of every body and the bin. `probes[i]` is the solid of `bodies[i]`.
std::vector<double> penetrations(const World& world, std::span<const BodyId> bodies,
                                 std::span<const SolidProbe* const> probes, const BinSpec& bin, const Pose& X_WB);

}  // namespace binpick

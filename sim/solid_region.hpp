// A closed mesh cut by planes into convex regions: for each the hull of the solid inside, and how much of that hull is
// air. Metres, the mesh's own frame.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "core/mesh.hpp"
#include "core/mesh_properties.hpp"

namespace binpick {

/// What of the solid lies behind some planes. Its hull encloses it; `air` are sample points in the hull but not in the
/// solid.
struct SolidRegion {
  using Polygon = std::vector<Eigen::Vector3d>;
  struct Plane {
    Eigen::Vector3d normal;
    double offset;  ///< the region has normal.p <= offset
  };
  std::vector<Plane> planes;
  std::vector<Polygon> surface;  ///< the mesh inside the region
  TriangleMesh hull;             ///< empty when the region holds no solid
  std::vector<Eigen::Vector3d> air;
};

class SolidSampler {
 public:
  /// `cells`: sample points along the longest edge of the mesh's bounding box.
  SolidSampler(const TriangleMesh& mesh, int cells);

  SolidRegion whole() const;
  /// The two regions on either side of the plane.
  std::array<SolidRegion, 2> cut(const SolidRegion& region, const SolidRegion::Plane& plane) const;
  /// Planes worth trying, along the axes and halfway between two of them: through flat faces, largest first, and evenly
  /// spread ones.
  std::vector<SolidRegion::Plane> candidates(const SolidRegion& region) const;
  double air_volume(const SolidRegion& region) const { return static_cast<double>(region.air.size()) * cell_volume_; }

 private:
  SolidRegion behind(const SolidRegion& parent, const SolidRegion::Plane& plane) const;
  void add_candidates(const SolidRegion& region, const Eigen::Vector3d& normal,
                      std::vector<SolidRegion::Plane>& result) const;
  std::vector<Eigen::Vector3d> inner_corners(const SolidRegion& region) const;
  bool inside(const Eigen::Vector3d& p) const;

  const TriangleMesh& mesh_;
  MeshQuery query_;
  double cell_ = 0, cell_volume_ = 0, gap_ = 0;
};

}  // namespace binpick

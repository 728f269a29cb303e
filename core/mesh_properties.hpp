// Geometry of a mesh: mass properties, diameter, closest point, rays.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/mesh.hpp"
#include "core/pose.hpp"

namespace binpick {

struct MassProperties {
  double volume = 0;                                    ///< m^3
  double mass = 0;                                      ///< kg
  Eigen::Vector3d center_P = Eigen::Vector3d::Zero();   ///< centre of mass
  Eigen::Matrix3d inertia_P = Eigen::Matrix3d::Zero();  ///< about the centre of mass, axes of P, kg m^2
};

/// Mass properties of a closed mesh (signed tetrahedra, exact for polyhedra).
MassProperties mass_properties(const TriangleMesh& mesh_P, double density);

/// Every edge is used as often in one direction as in the other: exactly twice on a simple solid, more often where
/// solids touch along an edge. Vertices at equal positions count as one.
bool is_closed(const TriangleMesh& mesh);

/// Largest distance between two vertices: exact (hull vertices first, then all pairs of those).
double mesh_diameter(const TriangleMesh& mesh);

/// The vertices on the convex hull (a superset is allowed); enough for diameter, MSSD and bounding boxes.
std::vector<Eigen::Vector3d> hull_vertices(const TriangleMesh& mesh);

Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh);
double surface_area(const TriangleMesh& mesh);

/// A mesh prepared for closest-point and ray queries (bounding-volume tree, double precision, fixed order).
class MeshQuery {
 public:
  explicit MeshQuery(const TriangleMesh& mesh);
  ~MeshQuery();
  MeshQuery(MeshQuery&&) noexcept;
  MeshQuery& operator=(MeshQuery&&) noexcept;

  struct Hit {
    double distance = 0;  ///< along the ray's direction (unit length), or to the closest point
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< outward, of the triangle
    std::uint32_t triangle = 0;
  };
  /// First triangle along origin + t * direction, t in [0, max_distance]; both sides of a triangle count, and a ray
  /// never slips between two triangles that share an edge. NaN or a zero direction: nothing. `distance` is t.
  std::optional<Hit> ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_distance) const;
  /// Closest point of the surface within max_distance.
  std::optional<Hit> closest(const Eigen::Vector3d& point, double max_distance) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace binpick

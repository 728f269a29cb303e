// Boxes, cylinders and spheres: robot links, tools, tables, bin walls. Metres.
#pragma once

#include <Eigen/Core>

#include "core/mesh.hpp"
#include "core/pose.hpp"

namespace binpick {

/// A solid with its own frame S in the frame of its owner O (a link, a tool, the world).
struct Primitive {
  enum class Kind { kBox, kCylinder, kSphere };
  Kind kind = Kind::kBox;
  Eigen::Vector3d size =
      Eigen::Vector3d::Ones();  ///< box: full edges; cylinder: radius, length along z, unused; sphere: radius
  Pose X_OS = Pose::Identity();

  static Primitive box(const Eigen::Vector3d& edges, const Pose& X_OS = Pose::Identity());
  static Primitive cylinder(double radius, double length, const Pose& X_OS = Pose::Identity());
  static Primitive sphere(double radius, const Pose& X_OS = Pose::Identity());
};

/// Closed mesh of the primitive in the owner's frame O; round solids get `segments` facets, vertices on the true
/// surface.
TriangleMesh mesh_of(const Primitive& primitive, int segments = 48);

/// `mesh_B` placed at X_AB.
TriangleMesh transformed(const Pose& X_AB, const TriangleMesh& mesh_B);

/// Adds `more` to `mesh` (same frame).
void append(TriangleMesh& mesh, const TriangleMesh& more);

}  // namespace binpick

// Parts known on paper, for the tests of physics: boxes, a ring of wedges, an L of two plates.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "core/part.hpp"
#include "core/primitive.hpp"

namespace binpick::example {

inline Part finished(Part part) {
  part.mesh_P = part.mesh_P.empty() ? part.envelope_P : part.mesh_P;
  part.mass = mass_properties(part.envelope_P, part.density);
  part.diameter = mesh_diameter(part.envelope_P);
  part.box_center_P = bounding_box(part.envelope_P).center();
  return part;
}

/// Box with edges `size`, its frame in one corner (so that P, box centre and mass centre differ).
inline Part box(const Eigen::Vector3d& size, double density = 2700, double friction = 0.4, double restitution = 0) {
  Part part;
  part.name = "box";
  part.envelope_P = mesh_of(Primitive::box(size, Pose(Eigen::Translation3d(size / 2))));
  part.pieces_P = {part.envelope_P};
  part.density = density;
  part.friction = friction;
  part.restitution = restitution;
  return finished(std::move(part));
}

/// Sector of a ring between two angles, z in [-height / 2, height / 2].
inline TriangleMesh ring_mesh(double inner, double outer, double height, int sectors) {
  TriangleMesh mesh;
  for (int k = 0; k < sectors; ++k) {
    const double angle = 2 * std::numbers::pi * k / sectors;
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0), up(0, 0, height / 2);
    for (const Eigen::Vector3d& v : {Eigen::Vector3d(inner * direction - up), Eigen::Vector3d(outer * direction - up),
                                     Eigen::Vector3d(outer * direction + up), Eigen::Vector3d(inner * direction + up)})
      mesh.vertices.push_back(v);
  }
  for (int k = 0; k < sectors; ++k)
    for (int corner = 0; corner < 4; ++corner) {
      const auto a = static_cast<std::uint32_t>(4 * k + corner),
                 b = static_cast<std::uint32_t>(4 * k + (corner + 1) % 4);
      const auto c = static_cast<std::uint32_t>(4 * ((k + 1) % sectors) + (corner + 1) % 4);
      const auto d = static_cast<std::uint32_t>(4 * ((k + 1) % sectors) + corner);
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// The bearing's envelope: 70 x 100 x 16 mm aluminium, eight wedges with three outer facets each.
inline Part ring() {
  Part part;
  part.name = "ring";
  part.envelope_P = ring_mesh(0.035, 0.05, 0.016, 48);
  part.density = 2700;
  for (int w = 0; w < 8; ++w) {
    TriangleMesh piece;
    for (int i = 0; i <= 6; i += 2)
      for (int corner = 0; corner < 4; ++corner)
        piece.vertices.push_back(part.envelope_P.vertices[static_cast<std::size_t>(4 * ((6 * w + i) % 48) + corner)]);
    part.pieces_P.push_back(piece);
  }
  return finished(std::move(part));
}

/// Two square pyramids base to base, apex up and down: its first contact lies under the mass centre.
inline Part bipyramid(double half_height, double half_width, double restitution) {
  Part part;
  part.name = "bipyramid";
  const double h = half_height, w = half_width;
  part.envelope_P.vertices = {{w, 0, 0}, {0, w, 0}, {-w, 0, 0}, {0, -w, 0}, {0, 0, h}, {0, 0, -h}};
  for (std::uint32_t k = 0; k < 4; ++k) {
    part.envelope_P.triangles.push_back({k, (k + 1) % 4, 4});
    part.envelope_P.triangles.push_back({(k + 1) % 4, k, 5});
  }
  part.pieces_P = {part.envelope_P};
  part.density = 2700;
  part.restitution = restitution;
  return finished(std::move(part));
}

/// A slope or floor: a thick fixed box whose top passes through the origin, turned about y by `angle`.
inline Primitive slab() { return Primitive::box({4, 4, 0.2}, Pose(Eigen::Translation3d(0, 0, -0.1))); }

}  // namespace binpick::example

// Parts made by hand for the tests of perception. Frame P as drawn; metres.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/mesh_properties.hpp"
#include "core/part.hpp"
#include "core/primitive.hpp"

namespace binpick::testing_scene {

/// Tube about z, inner and outer radius, height, centred; `segments` facets.
inline TriangleMesh ring_mesh(double inner, double outer, double height, int segments = 72) {
  TriangleMesh mesh;
  const double h = height / 2;
  const std::array<Eigen::Vector2d, 4> profile = {{{inner, -h}, {outer, -h}, {outer, h}, {inner, h}}};
  for (int s = 0; s < segments; ++s) {
    const double a = 2 * std::numbers::pi * s / segments;
    for (const auto& p : profile) mesh.vertices.emplace_back(p.x() * std::cos(a), p.x() * std::sin(a), p.y());
  }
  for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(segments); ++s)
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t next = (s + 1) % static_cast<std::uint32_t>(segments);
      const std::uint32_t a = 4 * s + k, b = 4 * next + k, c = 4 * next + (k + 1) % 4, d = 4 * s + (k + 1) % 4;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

inline Part part_from(const std::string& name, const TriangleMesh& mesh, const SymmetrySpec& symmetry) {
  Part part;
  part.name = name;
  part.mesh_P = part.envelope_P = mesh;
  part.density = 2700;
  if (symmetry.type != "auto") part.symmetry = make_symmetry(symmetry);  // an example that states none has none
  part.diameter = mesh_diameter(mesh);
  part.mass = mass_properties(mesh, part.density);
  part.box_center_P = bounding_box(mesh).center();
  return part;
}

/// The paper's bearing from outside: 70 x 100 x 16 mm.
inline Part ring_part() {
  SymmetrySpec s;
  s.type = "revolution";
  s.flip = true;
  return part_from("ring", ring_mesh(0.035, 0.05, 0.016), s);
}

/// The ring with twelve balls and a hidden inner tube that no camera sees.
inline TriangleMesh bearing_with_balls() {
  TriangleMesh mesh = ring_mesh(0.035, 0.05, 0.016);
  for (int k = 0; k < 12; ++k) {
    const double a = 2 * std::numbers::pi * k / 12;
    Pose X = Pose::Identity();
    X.translation() = Eigen::Vector3d(0.0425 * std::cos(a), 0.0425 * std::sin(a), 0);
    append(mesh, mesh_of(Primitive::sphere(0.0045, X), 16));
  }
  return mesh;
}

/// An L of two 6 mm plates with a boss: no symmetry. 90 x 60 x 60 mm.
inline Part bracket_part() {
  const auto at = [](double x, double y, double z) {
    Pose X = Pose::Identity();
    X.translation() = Eigen::Vector3d(x, y, z);
    return X;
  };
  TriangleMesh mesh = mesh_of(Primitive::box({0.09, 0.06, 0.006}, at(0.045, 0, 0.003)));
  append(mesh, mesh_of(Primitive::box({0.006, 0.06, 0.0535}, at(0.003, 0, 0.03325))));
  append(mesh, mesh_of(Primitive::cylinder(0.010, 0.0115, at(0.06, 0.012, 0.01225))));
  return part_from("bracket", mesh, {});
}

}  // namespace binpick::testing_scene

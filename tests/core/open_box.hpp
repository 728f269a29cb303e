// An open box as one closed mesh, as CAD would write it: outer and inner shell and the rim between them.
#pragma once

#include <array>

#include "core/mesh.hpp"

namespace binpick {

/// Inner size, and thickness of floor and walls, m. Frame B: centre of the inner floor, z up.
inline TriangleMesh open_box(const Eigen::Vector3d& inner, double wall) {
  TriangleMesh mesh;
  const auto ring = [&](double half_x, double half_y, double z) {
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      mesh.vertices.push_back({x * half_x, y * half_y, z});
  };
  const double x = inner.x() / 2, y = inner.y() / 2;
  ring(x + wall, y + wall, -wall);      // 0..3 outside below
  ring(x + wall, y + wall, inner.z());  // 4..7 outside above
  ring(x, y, inner.z());                // 8..11 inside above
  ring(x, y, 0);                        // 12..15 inside below
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t from : {0u, 4u, 8u})
    for (std::uint32_t i = 0; i < 4; ++i) quad(from + i, from + (i + 1) % 4, from + 4 + (i + 1) % 4, from + 4 + i);
  quad(3, 2, 1, 0);      // underside
  quad(12, 13, 14, 15);  // floor
  return mesh;
}

}  // namespace binpick

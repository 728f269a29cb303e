#include "sim/bin.hpp"

#include <cmath>

#include "core/bin_mesh.hpp"
#include "sim/bin_pieces.hpp"

namespace binpick {

BodyId add_bin(World& world, const BinSpec& bin, const Pose& X_WB) {
  const SurfaceMaterial material{bin.friction, bin.restitution};
  if (bin.mesh.empty()) return world.add_fixed(bin_boxes(bin, kThickWall), X_WB, material);
  BinSpec prepared = bin;
  prepare_bin(prepared);  // nothing left to do when the caller has done it
  return world.add_fixed_hulls(thickened(*prepared.pieces_B, prepared, kThickWall), X_WB, material);
}

BodyId add_drawn_bin(World& world, const BinSpec& bin, const Pose& X_WB) {
  const SurfaceMaterial material{bin.friction, bin.restitution};
  if (bin.mesh.empty()) return world.add_fixed(bin_boxes(bin, bin.wall), X_WB, material);
  BinSpec prepared = bin;
  prepare_bin(prepared);
  return world.add_fixed_hulls(*prepared.pieces_B, X_WB, material);
}

TriangleMesh drawn_bin(const BinSpec& bin) {
  if (!bin.mesh.empty()) {
    BinSpec loaded = bin;
    loaded.load();
    return loaded.solid->mesh_B;
  }
  TriangleMesh mesh;
  for (const Primitive& box : bin_boxes(bin, bin.wall)) append(mesh, mesh_of(box));
  return mesh;
}

BodyId add_guard_walls(World& world, const BinSpec& bin, const Pose& X_WB, double top) {
  const double rim = bin.inner_size.z(), height = top - rim, z = rim + height / 2;
  const double x = bin.rim_size().x(), y = bin.rim_size().y(), t = kThickWall;
  const auto at = [](double px, double py, double pz) { return Pose(Eigen::Translation3d(px, py, pz)); };
  const std::vector<Primitive> walls = {Primitive::box({t, y + 2 * t, height}, at(x / 2 + t / 2, 0, z)),
                                        Primitive::box({t, y + 2 * t, height}, at(-x / 2 - t / 2, 0, z)),
                                        Primitive::box({x + 2 * t, t, height}, at(0, y / 2 + t / 2, z)),
                                        Primitive::box({x + 2 * t, t, height}, at(0, -y / 2 - t / 2, z))};
  return world.add_fixed(walls, X_WB, {bin.friction, bin.restitution});
}

bool inside_bin(const BinSpec& bin, const Pose& X_WB, const Eigen::Vector3d& p_W, double above_rim) {
  const Eigen::Vector3d p_B = X_WB.inverse() * p_W;
  const Eigen::Vector2d half = bin.half_at(p_B.z());
  return std::abs(p_B.x()) <= half.x() && std::abs(p_B.y()) <= half.y() && p_B.z() >= -0.01 &&
         p_B.z() <= bin.inner_size.z() + above_rim;
}

}  // namespace binpick

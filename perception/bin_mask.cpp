#include "perception/bin_mask.hpp"

#include <algorithm>
#include <vector>

#include "core/bin_mesh.hpp"

namespace binpick {
namespace {

constexpr double kBehind = 0.2;  // m: a wall's back is never seen from inside

struct Slab {
  Pose X_SC;
  Eigen::Vector3d half;
};

std::vector<Slab> walls_of(const Scene& scene, double margin) {
  std::vector<Slab> slabs;
  const std::vector<Primitive> boxes = bin_boxes(*scene.bin, kBehind);
  for (std::size_t k = 1; k < boxes.size(); ++k)  // the first is the floor
    slabs.push_back({(scene.X_CB * boxes[k].X_OS).inverse(), boxes[k].size / 2 + Eigen::Vector3d::Constant(margin)});
  return slabs;
}

/// On the mesh of a bin from CAD; where that is floor, the floor's own cut decides.
bool on_mesh(const BinMesh& bin, const Eigen::Vector3d& p_B, double margin) {
  const auto hit = bin.surface.closest(p_B, margin);
  return hit && hit->point.z() > margin;
}

}  // namespace

void unmark_bin(Scene& scene, double margin) {
  const std::vector<Slab> slabs = walls_of(scene, margin);
  const BinMesh* mesh = scene.bin->solid.get();
  const Pose X_BC = scene.X_CB.inverse();
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u) {
      if (!scene.wanted(u, v)) continue;
      const Eigen::Vector3d p_C = scene.camera.unproject(u, v, scene.depth(u, v));
      scene.wanted(u, v) = std::none_of(slabs.begin(), slabs.end(), [&](const Slab& slab) {
        return ((slab.X_SC * p_C).array().abs() < slab.half.array()).all();
      });
      if (mesh && scene.wanted(u, v)) scene.wanted(u, v) = !on_mesh(*mesh, X_BC * p_C, margin);
    }
}

}  // namespace binpick

// What a camera looks at: meshes with poses, ids and reflectance. Built by trials from the world, drawn by a
// DepthRenderer.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/material.hpp"
#include "core/mesh.hpp"
#include "core/pose.hpp"
#include "sim/surface_texture.hpp"

namespace binpick {

/// Ids in the id image. Parts are 0 .. n-1 (their index in the heap); the rest of the cell starts at 1000.
inline constexpr std::int32_t kIdNothing = -1;
inline constexpr std::int32_t kIdBin = 1000;
inline constexpr std::int32_t kIdTable = 1001;
inline constexpr std::int32_t kIdTray = 1002;
inline constexpr std::int32_t kIdArm = 1003;
inline constexpr std::int32_t kIdTool = 1004;

struct RenderItem {
  std::shared_ptr<const TriangleMesh> mesh_O;
  Pose X_WO = Pose::Identity();
  std::int32_t id = kIdNothing;
  Material material;                                        ///< items that share an id share it
  std::shared_ptr<const SurfaceTexture> texture = nullptr;  ///< grey images alone show it; such an item's id is its own
};

struct RenderScene {
  std::vector<RenderItem> items;
};

/// Materials by id; an id that was never set has the default material.
class MaterialTable {
 public:
  MaterialTable() = default;
  explicit MaterialTable(const RenderScene& scene) {
    for (const RenderItem& item : scene.items) set(item.id, item.material);
  }
  void set(std::int32_t id, const Material& material) {
    if (id < 0) return;
    if (static_cast<std::size_t>(id) >= by_id_.size()) by_id_.resize(static_cast<std::size_t>(id) + 1);
    by_id_[static_cast<std::size_t>(id)] = material;
  }
  const Material& operator[](std::int32_t id) const {
    static const Material standard;
    return id >= 0 && static_cast<std::size_t>(id) < by_id_.size() ? by_id_[static_cast<std::size_t>(id)] : standard;
  }

 private:
  std::vector<Material> by_id_;
};

}  // namespace binpick

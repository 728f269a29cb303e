// What a camera looks at: meshes with poses, ids and reflectance. Built by trials from the world, drawn by a DepthRenderer.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/mesh.hpp"
#include "core/pose.hpp"

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
  float albedo = 0.6f;  ///< diffuse reflectance, 0 .. 1
};

struct RenderScene {
  std::vector<RenderItem> items;
};

}  // namespace binpick

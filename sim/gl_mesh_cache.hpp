// Private to sim: meshes on the (software) GPU, uploaded once each. The key is the mesh object itself; the cache holds
// a share of it, so its address cannot pass to another mesh, and lets go of meshes that nobody else holds any more.
#pragma once

#include <map>
#include <memory>

#include "core/mesh.hpp"
#include "sim/gl_context.hpp"

namespace binpick {

struct GlMesh {
  std::shared_ptr<const TriangleMesh> source;
  GLuint vertex_array = 0;
  GLuint buffers[3] = {0, 0, 0};  ///< vertices, indices, face normals
  GLuint normal_texture = 0;      ///< face normals by gl_PrimitiveID
  GLsizei index_count = 0;
};

class GlMeshCache {
 public:
  explicit GlMeshCache(GlContext& context) : context_(context) {}
  GlMeshCache(const GlMeshCache&) = delete;
  GlMeshCache& operator=(const GlMeshCache&) = delete;

  const GlMesh& get(const std::shared_ptr<const TriangleMesh>& mesh_O);
  /// Frees what only the cache still holds.
  void drop_unused();

 private:
  void upload(GlMesh& mesh);
  void free(GlMesh& mesh);

  GlContext& context_;
  std::map<const TriangleMesh*, GlMesh> meshes_;
};

}  // namespace binpick

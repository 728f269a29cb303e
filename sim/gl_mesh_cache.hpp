// Private to sim: meshes on the (software) GPU, uploaded once each. The key is the mesh object itself; the cache holds
// a share of it, so its address cannot pass to another mesh, and lets go of meshes that nobody else holds any more.
#pragma once

#include <map>
#include <memory>

#include "core/mesh.hpp"
#include "sim/facets.hpp"
#include "sim/gl_context.hpp"

namespace binpick {

struct GlMesh {
  std::shared_ptr<const TriangleMesh> source;
  GLuint vertex_array = 0;
  GLuint buffers[2] = {0, 0};  ///< vertices, indices
  GLsizei index_count = 0;
  std::unique_ptr<const MeshFacets> facets;
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

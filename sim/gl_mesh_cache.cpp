#include "sim/gl_mesh_cache.hpp"

#include <vector>

#include "core/check.hpp"

namespace binpick {

const GlMesh& GlMeshCache::get(const std::shared_ptr<const TriangleMesh>& mesh_O) {
  BP_CHECK(mesh_O != nullptr);
  GlMesh& mesh = meshes_[mesh_O.get()];
  if (mesh.source == nullptr) {
    mesh.source = mesh_O;
    mesh.facets = std::make_unique<const MeshFacets>(*mesh_O);
    upload(mesh);
  }
  return mesh;
}

void GlMeshCache::drop_unused() {
  for (auto it = meshes_.begin(); it != meshes_.end();) {
    if (it->second.source.use_count() > 1) {
      ++it;
    } else {
      free(it->second);
      it = meshes_.erase(it);
    }
  }
}

void GlMeshCache::upload(GlMesh& mesh) {
  const GlFunctions& gl = context_.use();
  const TriangleMesh& source = *mesh.source;
  if (source.empty()) return;
  std::vector<float> positions;
  positions.reserve(source.vertices.size() * 3);
  for (const Eigen::Vector3d& p : source.vertices)
    for (int i = 0; i < 3; ++i) positions.push_back(static_cast<float>(p[i]));
  const auto fill = [&](GLenum target, GLuint buffer, const void* data, std::size_t size) {
    gl.BindBuffer(target, buffer);
    gl.BufferData(target, static_cast<GLsizeiptr>(size), data, GL_STATIC_DRAW);
  };
  gl.GenVertexArrays(1, &mesh.vertex_array);
  gl.BindVertexArray(mesh.vertex_array);
  gl.GenBuffers(2, mesh.buffers);
  fill(GL_ARRAY_BUFFER, mesh.buffers[0], positions.data(), positions.size() * sizeof(float));
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl.EnableVertexAttribArray(0);
  static_assert(sizeof(source.triangles[0]) == 3 * sizeof(GLuint));
  fill(GL_ELEMENT_ARRAY_BUFFER, mesh.buffers[1], source.triangles.data(), source.triangles.size() * 3 * sizeof(GLuint));
  gl.BindVertexArray(0);
  mesh.index_count = static_cast<GLsizei>(source.triangles.size() * 3);
  context_.check("mesh upload");
}

void GlMeshCache::free(GlMesh& mesh) {
  if (mesh.index_count == 0) return;
  const GlFunctions& gl = context_.use();
  gl.DeleteBuffers(2, mesh.buffers);
  gl.DeleteVertexArrays(1, &mesh.vertex_array);
}

}  // namespace binpick

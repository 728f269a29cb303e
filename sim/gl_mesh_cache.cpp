#include "sim/gl_mesh_cache.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "core/check.hpp"

namespace binpick {
namespace {

// A triangle's number rides on its last corner (GL's provoking vertex) as the fourth coordinate, exact in a float up to
// 2^24. No two triangles share a last corner: one that nobody has taken yet is turned to the end, or a corner is
// copied. gl_PrimitiveID would say the same, but makes the software rasteriser copy three corners for every triangle.
struct DrawList {
  std::vector<float> vertices;  // x, y, z, triangle
  std::vector<GLuint> corners;
};

DrawList draw_list(const TriangleMesh& mesh) {
  BP_CHECK(mesh.triangles.size() < (std::size_t{1} << 24), mesh.triangles.size() << " triangles");
  DrawList list;
  const auto add = [&](const Eigen::Vector3d& p) {
    for (int i = 0; i < 3; ++i) list.vertices.push_back(static_cast<float>(p[i]));
    list.vertices.push_back(-1);
  };
  for (const Eigen::Vector3d& p : mesh.vertices) add(p);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<GLuint, 3> corners = mesh.triangles[t];
    for (int turn = 0; turn < 2 && list.vertices[4 * corners[2] + 3] >= 0; ++turn)
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    if (list.vertices[4 * corners[2] + 3] >= 0) {
      add(mesh.vertices[mesh.triangles[t][2]]);
      corners = mesh.triangles[t];
      corners[2] = static_cast<GLuint>(list.vertices.size() / 4 - 1);
    }
    list.vertices[4 * corners[2] + 3] = static_cast<float>(t);
    list.corners.insert(list.corners.end(), corners.begin(), corners.end());
  }
  return list;
}

}  // namespace

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
  const DrawList list = draw_list(source);
  const auto fill = [&](GLenum target, GLuint buffer, const void* data, std::size_t size) {
    gl.BindBuffer(target, buffer);
    gl.BufferData(target, static_cast<GLsizeiptr>(size), data, GL_STATIC_DRAW);
  };
  gl.GenVertexArrays(1, &mesh.vertex_array);
  gl.BindVertexArray(mesh.vertex_array);
  gl.GenBuffers(2, mesh.buffers);
  fill(GL_ARRAY_BUFFER, mesh.buffers[0], list.vertices.data(), list.vertices.size() * sizeof(float));
  gl.VertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl.EnableVertexAttribArray(0);
  fill(GL_ELEMENT_ARRAY_BUFFER, mesh.buffers[1], list.corners.data(), list.corners.size() * sizeof(GLuint));
  gl.BindVertexArray(0);
  mesh.index_count = static_cast<GLsizei>(list.corners.size());
  context_.check("mesh upload");
}

void GlMeshCache::free(GlMesh& mesh) {
  if (mesh.index_count == 0) return;
  const GlFunctions& gl = context_.use();
  gl.DeleteBuffers(2, mesh.buffers);
  gl.DeleteVertexArrays(1, &mesh.vertex_array);
}

}  // namespace binpick

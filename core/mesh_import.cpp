#include "core/mesh_import.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <set>

#include "core/error.hpp"
#include "core/one_line.hpp"

namespace binpick {
namespace {

/// Leaves one importer, so that no content can choose another of the fifty (several of which crash on bad bytes).
void keep_only(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* loader = importer.GetImporter(i);
    std::set<std::string> extensions;
    loader->GetExtensionList(extensions);
    if (extensions.count(extension)) continue;
    if (importer.UnregisterLoader(loader) == aiReturn_SUCCESS) delete loader;
  }
}

TriangleMesh converted(const aiMesh& source, const std::string& path) {
  TriangleMesh mesh;
  mesh.vertices.reserve(source.mNumVertices);
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    const aiVector3D& v = source.mVertices[i];
    mesh.vertices.emplace_back(v.x, v.y, v.z);
    if (!mesh.vertices.back().allFinite()) throw AssetError(path + ": a vertex is not finite");
  }
  mesh.triangles.reserve(source.mNumFaces);
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices < 3) continue;  // a polygon that shrinks to a line when it is cut into triangles
    if (face.mNumIndices > 3) throw AssetError(path + ": a face cannot be cut into triangles");
    for (unsigned k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= source.mNumVertices)
        throw AssetError(path + ": a face names a vertex that does not exist");
    }
    mesh.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
  }
  return mesh;
}

}  // namespace

std::vector<TriangleMesh> import_mesh(const std::string& bytes, const std::string& extension, const std::string& path) {
  Assimp::Importer importer;
  keep_only(importer, extension);
  unsigned steps = aiProcess_Triangulate;
  if (extension == "dae") {
    // A scene with nodes: their poses and the file's unit go into the vertices; the axis that is up is left as it
    // stands.
    steps |= aiProcess_PreTransformVertices;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  }
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), steps, extension.c_str());
  if (scene == nullptr) throw AssetError(path + ": cannot be read: " + one_line(importer.GetErrorString()));
  std::vector<TriangleMesh> meshes;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) meshes.push_back(converted(*scene->mMeshes[i], path));
  return meshes;
}

}  // namespace binpick

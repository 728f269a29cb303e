#include "core/link_mesh.hpp"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/isolated.hpp"
#include "core/mesh_bytes.hpp"
#include "core/mesh_import.hpp"
#include "core/primitive.hpp"

namespace binpick {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 28;  // bytes
constexpr unsigned kCpuSeconds = 60;

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

TriangleMesh merged(const std::vector<TriangleMesh>& objects) {
  TriangleMesh mesh;
  for (const TriangleMesh& object : objects) append(mesh, object);
  return mesh;
}

/// "+" and the corners of all triangles, three after the other, as bytes; or "-" and what is wrong.
std::string dae_corners(const std::string& bytes, const std::string& path) {
  try {
    const TriangleMesh mesh = merged(import_mesh(bytes, "dae", path));
    std::string out = "+";
    for (const auto& triangle : mesh.triangles)
      for (const auto corner : triangle)
        out.append(reinterpret_cast<const char*>(mesh.vertices[corner].data()), 3 * sizeof(double));
    return out;
  } catch (const AssetError& error) {
    return std::string("-") + error.what();
  }
}

/// Collada is XML with indices; nothing of ours has checked them, so the importer works in a process of its own.
TriangleMesh read_dae(const std::string& bytes, const std::string& path) {
  if (bytes.find("<COLLADA") == std::string::npos) throw AssetError(path + ": is no Collada file");
  const std::optional<std::string> answer = run_isolated([&] { return dae_corners(bytes, path); }, kCpuSeconds);
  if (!answer || answer->empty()) throw AssetError(path + ": is damaged: the Collada reader gave up on it");
  if (answer->front() == '-') throw AssetError(answer->substr(1));
  TriangleMesh mesh;
  for (std::size_t at = 1; at + 3 * sizeof(double) <= answer->size(); at += 3 * sizeof(double)) {
    mesh.vertices.emplace_back();
    std::memcpy(mesh.vertices.back().data(), answer->data() + at, 3 * sizeof(double));
  }
  for (std::uint32_t i = 0; i + 3 <= mesh.vertices.size(); i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

}  // namespace

TriangleMesh read_link_mesh(const std::string& path) {
  const std::string extension = extension_of(path);
  std::string bytes = read_file(path, kLargestFile);
  if (bytes.empty()) throw AssetError(path + ": is empty");
  TriangleMesh mesh;
  if (extension == ".dae") {
    mesh = read_dae(bytes, path);
  } else if (extension == ".stl") {
    mesh = merged(import_mesh(checked_stl(std::move(bytes), path), "stl", path));
  } else if (extension == ".obj") {
    mesh = merged(import_mesh(checked_obj(bytes, path), "obj", path));
  } else if (extension == ".ply") {
    mesh = merged(import_mesh(checked_ply(bytes, path), "ply", path));
  } else {
    throw AssetError(path + ": link meshes '" + shown(extension) + "' are not read (.stl, .dae, .obj, .ply)");
  }
  if (mesh.triangles.empty()) throw AssetError(path + ": holds no triangles");
  return mesh;
}

}  // namespace binpick

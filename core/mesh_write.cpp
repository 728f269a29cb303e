#include <Eigen/Geometry>
#include <array>
#include <cstring>

#include "core/check.hpp"
#include "core/file_io.hpp"
#include "core/mesh_io.hpp"
#include "core/quantity.hpp"

namespace binpick {
namespace {

constexpr double kMillimetres = 1000;  // per metre

void put(std::string& bytes, const Eigen::Vector3d& v) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto value = static_cast<float>(v[k]);
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  }
}

}  // namespace

void write_stl(const std::string& path, const TriangleMesh& mesh) {
  BP_CHECK(mesh.triangles.size() < 0xffffffffu);
  std::string bytes = "binary STL, millimetres";
  bytes.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  char raw[sizeof count];
  std::memcpy(raw, &count, sizeof count);
  bytes.append(raw, sizeof count);
  for (const auto& t : mesh.triangles) {
    const std::array<Eigen::Vector3d, 3> corner = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    put(bytes, normal.stableNormalized());
    for (const Eigen::Vector3d& p : corner) put(bytes, kMillimetres * p);
    bytes.append(2, '\0');
  }
  write_file(path, bytes);
}

void write_ply(const std::string& path, const TriangleMesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\ncomment millimetres\nelement vertex " +
                     std::to_string(mesh.vertices.size()) +
                     "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                     std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const Eigen::Vector3d mm = kMillimetres * v;
    text += format_double(mm.x()) + " " + format_double(mm.y()) + " " + format_double(mm.z()) + "\n";
  }
  for (const auto& t : mesh.triangles) {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  }
  write_file(path, text);
}

}  // namespace binpick

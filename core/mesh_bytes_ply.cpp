#include <algorithm>

#include "core/error.hpp"
#include "core/mesh_bytes.hpp"
#include "core/ply_bytes.hpp"

namespace binpick {
namespace {

bool is_coordinate(const std::string& name) { return name == "x" || name == "y" || name == "z"; }
bool is_index_list(const PlyProperty& p) {
  return p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index") &&
         p.value.kind != PlyScalar::Kind::kReal;
}

/// Corners of one face: at least three, each an existing vertex. Returns the triangles it makes.
std::uint64_t check_face(PlyValues& values, const PlyProperty& list, std::uint64_t vertices) {
  const double corners = values.next(list.count);
  if (corners < 3) throw AssetError(values.place() + ": a face with fewer than three corners");
  if (corners > static_cast<double>(kMostCorners))
    throw AssetError(values.place() + ": a face with more than " + std::to_string(kMostCorners) + " corners");
  const auto count = static_cast<std::uint64_t>(corners);
  for (std::uint64_t k = 0; k < count; ++k) {
    const double index = values.next(list.value);
    if (index < 0 || index >= static_cast<double>(vertices)) {
      throw AssetError(values.place() + ": vertex " + std::to_string(static_cast<std::int64_t>(index)) +
                       " does not exist, the file has " + std::to_string(vertices));
    }
  }
  return count - 2;
}

void check_other(PlyValues& values, const PlyElement& element, const PlyProperty& property) {
  const double repeats = property.is_list ? values.next(property.count) : 1;
  if (repeats < 0) throw AssetError(values.place() + ": a list with a negative count");
  for (double k = 0; k < repeats; ++k) {
    const double value = values.next(property.value);
    if (element.name == "vertex" && is_coordinate(property.name)) check_coordinate(value, values.place());
  }
}

void check_shape(const PlyHeader& header, const std::string& path, std::uint64_t& vertices) {
  bool faces = false;
  for (const PlyElement& element : header.elements) {
    const auto& p = element.properties;
    if (element.name == "vertex") {
      const auto found =
          std::count_if(p.begin(), p.end(), [](const PlyProperty& q) { return !q.is_list && is_coordinate(q.name); });
      if (found != 3) throw AssetError(path + ": the vertices lack x, y or z");
      vertices = element.count;
    }
    if (element.name == "face") faces = element.count > 0 && std::count_if(p.begin(), p.end(), is_index_list) == 1;
    if (element.count > 0 && p.empty())
      throw AssetError(path + ": element '" + shown(element.name) + "' has no properties");
  }
  if (!faces) throw AssetError(path + ": holds no faces");
}

}  // namespace

std::string checked_ply(std::string bytes, const std::string& path) {
  const PlyHeader header = read_ply_header(bytes, path);
  std::uint64_t vertices = 0;
  check_shape(header, path, vertices);
  const std::unique_ptr<PlyValues> values = ply_values(bytes, path, header);
  std::uint64_t triangles = 0;
  for (const PlyElement& element : header.elements) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values->begin_record();
      for (const PlyProperty& property : element.properties) {
        if (element.name == "face" && is_index_list(property)) {
          triangles += check_face(*values, property, vertices);
        } else {
          check_other(*values, element, property);
        }
      }
      values->end_record();
      if (triangles > kMostTriangles) {
        throw AssetError(path + ": more than " + std::to_string(kMostTriangles) + " triangles");
      }
    }
  }
  values->end();
  return bytes;
}

}  // namespace binpick

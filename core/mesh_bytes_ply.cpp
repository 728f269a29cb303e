#include <algorithm>
#include <array>
#include <memory>

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

/// The file as the importer gets it. It is written anew: where the importer's reading of a header, of names or of the
/// first byte after the header departs from ours, it writes beyond its arrays.
class PlyWriter {
 public:
  void vertex(const std::array<float, 3>& xyz) {
    vertices_ += ' ';  // the first byte of the data must not look like another line end of the header
    vertices_.append(reinterpret_cast<const char*>(xyz.data()), sizeof xyz);
    ++vertex_count_;
  }
  void corner_count(std::int32_t count) {
    add(count);
    ++face_count_;
  }
  void corner(std::int32_t vertex) { add(vertex); }
  std::string bytes() const {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertex_count_) +
           "\nproperty uchar pad\nproperty float x\nproperty float y\nproperty float z\nelement face " +
           std::to_string(face_count_) + "\nproperty list int int vertex_indices\nend_header\n" + vertices_ + faces_;
  }

 private:
  void add(std::int32_t value) { faces_.append(reinterpret_cast<const char*>(&value), sizeof value); }

  std::string vertices_, faces_;
  std::uint64_t vertex_count_ = 0, face_count_ = 0;
};

class PlyChecker {
 public:
  PlyChecker(const std::string& bytes, const std::string& path)
      : path_(path), header_(read_ply_header(bytes, path)), values_(ply_values(bytes, path, header_)) {
    check_shape();
  }

  std::string checked() {
    for (const PlyElement& element : header_.elements)
      for (std::uint64_t i = 0; i < element.count; ++i) record(element);
    values_->end();
    return out_.bytes();
  }

 private:
  void check_shape() {
    int vertices = 0, faces = 0;
    for (const PlyElement& element : header_.elements) {
      const auto& p = element.properties;
      if (element.name == "vertex") {
        ++vertices;
        vertices_ = element.count;
        for (const char* name : {"x", "y", "z"})
          if (std::count_if(p.begin(), p.end(), [&](const PlyProperty& q) { return !q.is_list && q.name == name; }) !=
              1)
            throw AssetError(path_ + ": the vertices lack x, y or z");
      }
      if (element.name == "face")
        faces += element.count > 0 && std::count_if(p.begin(), p.end(), is_index_list) == 1 ? 1 : 2;
      if (element.count > 0 && p.empty())
        throw AssetError(path_ + ": element '" + shown(element.name) + "' has no properties");
    }
    if (vertices != 1) throw AssetError(path_ + ": must hold one list of vertices");
    if (faces != 1) throw AssetError(path_ + ": holds no faces");
  }

  void record(const PlyElement& element) {
    std::array<float, 3> xyz{};
    values_->begin_record();
    for (const PlyProperty& property : element.properties) {
      if (element.name == "face" && is_index_list(property)) {
        face(property);
      } else if (element.name == "vertex" && !property.is_list && is_coordinate(property.name)) {
        const double value = values_->next(property.value);
        check_coordinate(value, values_->place());
        xyz[static_cast<std::size_t>(property.name[0] - 'x')] = static_cast<float>(value);
      } else {
        skip(property);
      }
    }
    values_->end_record();
    if (element.name == "vertex") out_.vertex(xyz);
  }

  /// At least three corners, each an existing vertex.
  void face(const PlyProperty& list) {
    const double corners = values_->next(list.count);
    if (corners < 3) fail("a face with fewer than three corners");
    if (corners > static_cast<double>(kMostCorners))
      fail("a face with more than " + std::to_string(kMostCorners) + " corners");
    const auto count = static_cast<std::int32_t>(corners);
    out_.corner_count(count);
    for (std::int32_t k = 0; k < count; ++k) {
      const double index = values_->next(list.value);
      if (index < 0 || index >= static_cast<double>(vertices_))
        fail("vertex " + std::to_string(static_cast<std::int64_t>(index)) + " does not exist, the file has " +
             std::to_string(vertices_));
      out_.corner(static_cast<std::int32_t>(index));
    }
    triangles_ += static_cast<std::uint64_t>(count) - 2;
    if (triangles_ > kMostTriangles)
      throw AssetError(path_ + ": more than " + std::to_string(kMostTriangles) + " triangles");
  }

  void skip(const PlyProperty& property) {
    const double repeats = property.is_list ? values_->next(property.count) : 1;
    if (repeats < 0) fail("a list with a negative count");
    for (double k = 0; k < repeats; ++k) values_->next(property.value);
  }

  [[noreturn]] void fail(const std::string& message) const { throw AssetError(values_->place() + ": " + message); }

  const std::string& path_;
  PlyHeader header_;
  std::unique_ptr<PlyValues> values_;
  std::uint64_t vertices_ = 0, triangles_ = 0;
  PlyWriter out_;
};

}  // namespace

std::string checked_ply(const std::string& bytes, const std::string& path) { return PlyChecker(bytes, path).checked(); }

}  // namespace binpick

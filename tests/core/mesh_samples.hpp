// A block of 60 x 40 x 20 mm as the text and bytes of every format that is read, for the tests that spoil them.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include "core/file_io.hpp"
#include "core/primitive.hpp"
#include "core/quantity.hpp"

namespace binpick::samples {

/// Metres; off its origin.
inline const TriangleMesh& block() {
  static const TriangleMesh mesh =
      mesh_of(Primitive::box({0.06, 0.04, 0.02}, Pose(Eigen::Translation3d(0.01, 0.02, 0.03))));
  return mesh;
}

inline std::string mm(const Eigen::Vector3d& v) {
  const Eigen::Vector3d p = (1000 * v).array().round();
  return format_double(p.x()) + " " + format_double(p.y()) + " " + format_double(p.z());
}

inline std::string ascii_stl() {
  std::string text = "solid block\n";
  for (const auto& t : block().triangles) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const auto corner : t) text += "      vertex " + mm(block().vertices[corner]) + "\n";
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid block\n";
}

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

inline std::string binary_stl(double scale = 1000) {
  std::string bytes(80, ' ');
  put(bytes, static_cast<std::uint32_t>(block().triangles.size()));
  for (const auto& t : block().triangles) {
    for (int k = 0; k < 3; ++k) put(bytes, 0.0f);
    for (const auto corner : t) {
      for (Eigen::Index k = 0; k < 3; ++k) put(bytes, static_cast<float>(scale * block().vertices[corner][k]));
    }
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

inline std::string obj() {
  std::string text = "# a block\nmtllib block.mtl\no block\n";
  for (const auto& v : block().vertices) text += "v " + mm(v) + "\n";
  for (const auto& t : block().triangles) {
    text += "f";
    for (const auto corner : t) text += " " + std::to_string(corner + 1);
    text += "\n";
  }
  return text;
}

inline std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment a block\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string ascii_ply() {
  std::string text = ply_header("ascii");
  for (const auto& v : block().vertices) text += mm(v) + "\n";
  for (const auto& t : block().triangles) {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  }
  return text;
}

inline std::string binary_ply(bool big_endian) {
  std::string bytes = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian");
  const auto put_ordered = [&](auto value) {
    std::string raw;
    put(raw, value);
    bytes += big_endian ? std::string(raw.rbegin(), raw.rend()) : raw;
  };
  for (const auto& v : block().vertices) {
    for (Eigen::Index k = 0; k < 3; ++k) put_ordered(static_cast<float>(1000 * v[k]));
  }
  for (const auto& t : block().triangles) {
    put_ordered(std::uint8_t{3});
    for (const auto corner : t) put_ordered(static_cast<std::int32_t>(corner));
  }
  return bytes;
}

/// The T-piece as tracked in the repository: 64 x 60 x 16 mm.
inline std::string step() { return read_file(std::string(BINPICK_SOURCE_DIR) + "/assets/parts/tee/tee.step"); }

/// The same numbers in another unit.
inline std::string step_in(const std::string& unit) {
  std::string text = step();
  const std::string millimetre = "SI_UNIT(.MILLI.,.METRE.)";
  const std::string line = "( LENGTH_UNIT() NAMED_UNIT(*) " + millimetre + " )";
  const std::size_t at = text.find(line);
  if (unit != "inch") return text.replace(at, line.size(), "( LENGTH_UNIT() NAMED_UNIT(*) " + unit + " )");
  text.replace(at, line.size(), "( CONVERSION_BASED_UNIT('INCH',#9001) LENGTH_UNIT() NAMED_UNIT(#9003) )");
  return text.insert(text.rfind("ENDSEC;"),
                     "#9001 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9002);\n"
                     "#9002 = " +
                         line + ";\n#9003 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n");
}

/// `text` with the first `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? "sample does not hold '" + from + "'" : text.replace(at, from.size(), to);
}

inline std::string with_float(std::string bytes, std::size_t offset, float value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
  return bytes;
}

inline std::string with_u32(std::string bytes, std::size_t offset, std::uint32_t value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
  return bytes;
}

}  // namespace binpick::samples

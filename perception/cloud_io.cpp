#include "perception/cloud_io.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/check.hpp"
#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/ply_bytes.hpp"

namespace binpick {
namespace {

static_assert(std::endian::native == std::endian::little, "the values are written as they lie");
constexpr std::array<const char*, 6> kFields = {"x", "y", "z", "nx", "ny", "nz"};
constexpr double kFarthest = 1000;  // m: a cloud in millimetres of anything but a small part would lie beyond

void append(std::string& bytes, const Eigen::Vector3d& values) {
  for (int k = 0; k < 3; ++k) {
    const auto value = static_cast<float>(values[k]);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
}

/// Index into kFields; its size when the property is none of them.
std::size_t field_of(const PlyProperty& property) {
  std::size_t k = 0;
  while (k < kFields.size() && (property.is_list || property.name != kFields[k])) ++k;
  return k;
}

/// Which of x, y, z, nx, ny, nz the vertices carry, as bits.
unsigned fields_of(const PlyElement& element, const std::string& path) {
  unsigned fields = 0;
  for (const PlyProperty& property : element.properties) {
    const std::size_t k = field_of(property);
    if (k == kFields.size()) continue;
    if (fields >> k & 1) throw AssetError(path + ": the vertices have " + kFields[k] + " twice");
    fields |= 1u << k;
  }
  if ((fields & 7) != 7) throw AssetError(path + ": the vertices lack x, y or z");
  if (fields != 7 && fields != 63) throw AssetError(path + ": the normals lack nx, ny or nz");
  return fields;
}

void skip_list(PlyValues& values, const PlyProperty& property) {
  const double repeats = values.next(property.count);
  if (repeats < 0) throw AssetError(values.place() + ": a list with a negative count");
  for (double k = 0; k < repeats; ++k) values.next(property.value);
}

void read_vertex(PlyValues& values, const PlyElement& element, bool normals, PointCloud& cloud) {
  std::array<double, 6> fields = {};
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) {
      skip_list(values, property);
      continue;
    }
    const double value = values.next(property.value);
    if (const std::size_t k = field_of(property); k < kFields.size()) fields[k] = value;
  }
  const Eigen::Vector3d point(fields[0], fields[1], fields[2]), normal(fields[3], fields[4], fields[5]);
  if (!point.allFinite() || !normal.allFinite()) throw AssetError(values.place() + ": a value is not a number");
  if (point.cwiseAbs().maxCoeff() > kFarthest)
    throw AssetError(values.place() + ": a coordinate beyond 1 km; clouds are in metres");
  cloud.points.push_back(point);
  if (!normals) return;
  const double length = normal.norm();
  Eigen::Vector3d unit = Eigen::Vector3d::Zero();
  if (length > 1e-6) unit = normal / length;
  // As written by us: not a bit is changed.
  cloud.normals.push_back(std::abs(length - 1) < 1e-6 ? normal : unit);
}

void skip_record(PlyValues& values, const PlyElement& element) {
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) {
      skip_list(values, property);
    } else {
      values.next(property.value);
    }
  }
}

}  // namespace

void write_cloud_ply(const std::string& path, const PointCloud& cloud, const std::string& comment) {
  BP_CHECK(cloud.normals.empty() || cloud.has_normals());
  BP_CHECK(comment.find_first_of("\r\n") == std::string::npos);
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment " + comment + "\nelement vertex " +
                      std::to_string(cloud.size()) + "\n";
  for (std::size_t k = 0; k < (cloud.has_normals() ? 6u : 3u); ++k)
    bytes += std::string("property float ") + kFields[k] + "\n";
  bytes += "end_header\n";
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    append(bytes, cloud.points[i]);
    if (cloud.has_normals()) append(bytes, cloud.normals[i]);
  }
  write_file(path, bytes);
}

PointCloud read_cloud_ply(const std::string& path) {
  const std::string bytes = read_file(path);
  const PlyHeader header = read_ply_header(bytes, path);
  const std::unique_ptr<PlyValues> values = ply_values(bytes, path, header);
  PointCloud cloud;
  bool found = false;
  for (const PlyElement& element : header.elements) {
    const bool vertices = element.name == "vertex";
    if (vertices && found) throw AssetError(path + ": has vertices twice");
    if (element.count > 0 && element.properties.empty())
      throw AssetError(path + ": an element of the header has no properties");
    const bool normals = vertices && fields_of(element, path) == 63;
    found = found || vertices;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values->begin_record();
      vertices ? read_vertex(*values, element, normals, cloud) : skip_record(*values, element);
      values->end_record();
    }
  }
  values->end();
  if (!found) throw AssetError(path + ": holds no vertices");
  return cloud;
}

}  // namespace binpick

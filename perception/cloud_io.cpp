#include "perception/cloud_io.hpp"

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/check.hpp"
#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/isolated.hpp"
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

/// Length one, or zero where there is none. As written by us: not a bit is changed.
Eigen::Vector3d unit_or_zero(const Eigen::Vector3d& normal) {
  const double length = normal.norm();
  if (std::abs(length - 1) < 1e-6) return normal;
  return length > 1e-6 && std::isfinite(length) ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
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
  cloud.normals.push_back(unit_or_zero(normal));
}

// ---- PCD, in a process of its own. What it sends back: 'E' and a message, or 'P' / 'N' and three / six doubles a
// point.

constexpr unsigned kReaderSeconds = 60;            // of processor time
constexpr rlim_t kReaderMemory = rlim_t{4} << 30;  // bytes; a header may promise any number of points
constexpr std::array<const char*, 6> kPcdFields = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};

void limit_memory() {
  unsigned long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t now = static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  const rlimit limit{now + kReaderMemory, now + kReaderMemory};
  ::setrlimit(RLIMIT_AS, &limit);
}

double real_at(const std::uint8_t* bytes, std::uint8_t type) {
  if (type == pcl::PCLPointField::FLOAT64) {
    double value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  float value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// Fields of the blob in kPcdFields' order; fewer than six when there are no normals. A message when they cannot be
/// used.
std::string find_fields(const pcl::PCLPointCloud2& blob, std::vector<pcl::PCLPointField>& fields) {
  for (const char* name : kPcdFields) {
    const auto field =
        std::find_if(blob.fields.begin(), blob.fields.end(), [&](const auto& f) { return f.name == name; });
    if (field == blob.fields.end()) break;
    if (field->datatype != pcl::PCLPointField::FLOAT32 && field->datatype != pcl::PCLPointField::FLOAT64)
      return std::string("its field ") + name + " does not hold real numbers";
    fields.push_back(*field);
  }
  if (fields.size() < 3) return "its points lack x, y or z";
  fields.resize(fields.size() < 6 ? 3 : 6);
  return "";
}

std::string pcd_bytes(const std::string& path) {
  limit_memory();
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  pcl::PCLPointCloud2 blob;
  pcl::PCDReader reader;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0, kind = 0;
  unsigned int begin = 0;  // of the values; stays 0 where the header never ends
  const bool header = reader.readHeader(path, blob, origin, orientation, version, kind, begin) == 0 && begin > 0;
  if (!header || reader.read(path, blob) < 0) return "Eis not a PCD file that can be read";
  std::vector<pcl::PCLPointField> fields;
  if (const std::string message = find_fields(blob, fields); !message.empty()) return "E" + message;
  const std::size_t count = static_cast<std::size_t>(blob.width) * blob.height;
  if (blob.data.size() < count * blob.point_step) return "Eends before the points its header promises";
  std::string bytes(1, fields.size() == 6 ? 'N' : 'P');
  for (std::size_t i = 0; i < count; ++i) {
    for (const pcl::PCLPointField& field : fields) {
      const double value = real_at(blob.data.data() + i * blob.point_step + field.offset, field.datatype);
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
  return bytes;
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

PointCloud read_cloud_pcd(const std::string& path) {
  read_file(path);  // says what is wrong with the path
  const std::string bytes = run_isolated([&] { return pcd_bytes(path); }, kReaderSeconds).value_or("");
  if (bytes.empty()) throw AssetError(path + ": is not a PCD file that can be read");
  if (bytes[0] == 'E') throw AssetError(path + ": " + bytes.substr(1));
  const bool normals = bytes[0] == 'N';
  const std::size_t step = (normals ? 6 : 3) * sizeof(double);
  PointCloud cloud;
  for (std::size_t at = 1; at + step <= bytes.size(); at += step) {
    std::array<double, 6> values = {};
    std::memcpy(values.data(), bytes.data() + at, step);
    const Eigen::Vector3d point(values[0], values[1], values[2]);
    if (!point.allFinite()) continue;  // no return
    if (point.cwiseAbs().maxCoeff() > kFarthest)
      throw AssetError(path + ": a coordinate beyond 1 km; clouds are in metres");
    cloud.points.push_back(point);
    if (normals) cloud.normals.push_back(unit_or_zero({values[3], values[4], values[5]}));
  }
  return cloud;
}

PointCloud read_cloud(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".ply") return read_cloud_ply(path);
  if (extension == ".pcd") return read_cloud_pcd(path);
  throw AssetError(path + ": clouds are read from .ply and .pcd");
}

}  // namespace binpick

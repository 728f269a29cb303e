#include "core/mesh_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/mesh_bytes.hpp"
#include "core/mesh_import.hpp"
#include "core/mesh_properties.hpp"
#include "core/mesh_repair.hpp"
#include "core/primitive.hpp"
#include "core/step_io.hpp"

namespace binpick {
namespace {

constexpr double kSmallestDiameter = 0.001;  // m
constexpr double kLargestDiameter = 2;       // m
constexpr double kFarthest = 100;            // diameters: float files have lost 1e-5 of the diameter there
constexpr double kWeldFraction = 1e-6;       // of the bounding box: decimals that an ASCII file has lost

struct LengthUnit {
  const char* name;
  double metres;
};
constexpr std::array<LengthUnit, 4> kUnits = {{{"m", 1}, {"mm", 0.001}, {"inch", 0.0254}, {"cm", 0.01}}};

double metres_per(const std::string& unit, const std::string& path) {
  for (const LengthUnit& known : kUnits) {
    if (unit == known.name || (unit.empty() && std::string(known.name) == "mm")) return known.metres;
  }
  throw AssetError(path + ": unit '" + shown(unit) + "' is not known (mm, cm, m, inch)");
}

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

bool is_step(const std::string& extension) { return extension == ".step" || extension == ".stp"; }

std::string in_mm(double metres) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g mm", 1000 * metres);
  return text;
}

/// Which unit would make a part of this: "", or a hint for the message.
std::string unit_hint(double diameter, double metres) {
  for (const LengthUnit& unit : kUnits) {
    const double as = diameter / metres * unit.metres;
    if (unit.metres != metres && as >= kSmallestDiameter && as <= kLargestDiameter) {
      return std::string("; with `unit: ") + unit.name + "` it would be " + in_mm(as);
    }
  }
  return "";
}

void check_size(const TriangleMesh& mesh, double metres, bool step, const std::string& path) {
  const double diameter = mesh_diameter(mesh);
  if (!(diameter >= kSmallestDiameter && diameter <= kLargestDiameter)) {
    throw AssetError(path + ": a diameter of " + in_mm(diameter) + " lies outside 1 mm .. 2000 mm" +
                     (step ? "" : unit_hint(diameter, metres)));
  }
  const double away = bounding_box(mesh).center().norm();
  if (away > kFarthest * diameter) {
    throw AssetError(path + ": the part lies " + in_mm(away) + " from its origin, more than " +
                     std::to_string(static_cast<int>(kFarthest)) + " times its diameter; move it there");
  }
}

std::vector<TriangleMesh> read_objects(const std::string& path, const std::string& extension) {
  std::string bytes = read_file(path);
  if (bytes.empty()) throw AssetError(path + ": is empty");
  if (extension == ".stl") {
    bytes = checked_stl(std::move(bytes), path);
  } else if (extension == ".obj") {
    bytes = checked_obj(bytes, path);
  } else if (extension == ".ply") {
    bytes = checked_ply(bytes, path);
  } else {
    throw AssetError(path + ": files '" + shown(extension) + "' are not read (.stl, .obj, .ply, .step, .stp)");
  }
  return import_mesh(bytes, extension.substr(1), path);
}

void scale(TriangleMesh& mesh, double factor) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= factor;
}

MeshRepairs repair(TriangleMesh& mesh, const std::string& path) {
  if (mesh.empty()) throw AssetError(path + ": holds no triangles");
  const MeshRepairs repairs = repair_mesh(mesh, kWeldFraction * bounding_box(mesh).sizes().norm());
  if (mesh.empty()) throw AssetError(path + ": every triangle has zero area");
  return repairs;
}

}  // namespace

TriangleMesh read_mesh(const std::string& path, const MeshReadOptions& options, MeshReadReport* report) {
  const std::string extension = extension_of(path);
  const bool step = is_step(extension);
  const double metres = metres_per(options.unit, path);
  if (step && !options.unit.empty()) throw AssetError(path + ": STEP files carry their own unit; leave `unit` out");
  TriangleMesh mesh;
  if (step) {
    mesh = read_step(path, options.chord_tolerance / options.scale);
    scale(mesh, options.scale);
  } else {
    for (const TriangleMesh& object : read_objects(path, extension)) append(mesh, object);
    scale(mesh, metres * options.scale);
  }
  const MeshRepairs repairs = repair(mesh, path);
  check_size(mesh, metres, step, path);
  if (report != nullptr) {
    *report = {repairs.dropped_triangles, repairs.merged_vertices, repairs.turned_triangles, repairs.turned_inside_out,
               is_closed(mesh)};
  }
  return mesh;
}

std::vector<TriangleMesh> read_mesh_objects(const std::string& path, const MeshReadOptions& options) {
  const std::string extension = extension_of(path);
  if (extension != ".obj") throw AssetError(path + ": pieces are the objects of an .obj file");
  const double metres = metres_per(options.unit, path);
  std::vector<TriangleMesh> objects = read_objects(path, extension);
  TriangleMesh all;
  for (TriangleMesh& object : objects) {
    scale(object, metres * options.scale);
    repair(object, path);
    append(all, object);
  }
  check_size(all, metres, false, path);
  return objects;
}

}  // namespace binpick

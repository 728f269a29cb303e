// CAD files -> TriangleMesh, strictly: STL (binary, ASCII), OBJ and PLY through assimp behind a fixed importer list,
// STEP through Open CASCADE (step_io). Our own checks stand before and after, since the importer lets NaN, 1e38 and
// decimal commas through. Length unit of STL, OBJ, PLY: mm unless `unit` says otherwise; STEP files carry their own.
#pragma once

#include <string>
#include <vector>

#include "core/mesh.hpp"

namespace binpick {

struct MeshReadOptions {
  std::string unit;               ///< "mm", "m", "inch", "cm"; empty: mm, or the STEP file's own
  double chord_tolerance = 1e-4;  ///< m, largest distance of a STEP facet from its surface
  double scale = 1;               ///< of the shape in the file, about its origin
};

/// What was repaired on the way in (zero-area triangles, duplicate vertices, inside-out orientation), for the log.
struct MeshReadReport {
  std::size_t dropped_triangles = 0;
  std::size_t merged_vertices = 0;
  std::size_t turned_triangles = 0;  ///< that disagreed with their neighbours
  bool turned_inside_out = false;
  bool closed = false;
};

/// Reads a mesh in metres. Throws AssetError in one line: file, place, what is wrong, and the unit that would fit when
/// the diameter lies outside 1 mm .. 2 m.
TriangleMesh read_mesh(const std::string& path, const MeshReadOptions& options = {}, MeshReadReport* report = nullptr);

/// The objects of an OBJ file as meshes of their own, in the order of the file: the convex pieces of a part. The same
/// checks; the limits on the diameter hold for all objects together.
std::vector<TriangleMesh> read_mesh_objects(const std::string& path, const MeshReadOptions& options = {});

/// Writes binary STL in millimetres (the habit of CAD), and PLY (ascii, mm). Throws StorageError.
void write_stl(const std::string& path, const TriangleMesh& mesh);
void write_ply(const std::string& path, const TriangleMesh& mesh);

}  // namespace binpick

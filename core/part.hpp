// part.yaml -> Part: everything the other rooms know about a part. Frame P is the part as drawn in its CAD file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/material.hpp"
#include "core/mesh.hpp"
#include "core/mesh_properties.hpp"
#include "core/symmetry.hpp"

namespace binpick {

struct Part {
  std::string name;
  TriangleMesh mesh_P;       ///< as drawn, inner details included: this is what CAD holds and cameras look at
  TriangleMesh envelope_P;   ///< outer envelope for collision and mass; equal to mesh_P unless part.yaml names one
  std::vector<TriangleMesh> pieces_P;  ///< convex pieces whose union is the envelope; empty: sim decomposes
  double density = 0;        ///< kg/m^3
  double friction = 0.4;     ///< Coulomb coefficient of the part against itself and the bin (pairs are combined by sim)
  double restitution = 0.1;
  Material surface;          ///< how it returns light
  Symmetry symmetry;
  double diameter = 0;       ///< m, largest distance between two points of the mesh
  MassProperties mass;       ///< of the envelope
  Eigen::Vector3d box_center_P = Eigen::Vector3d::Zero();  ///< centre of the mesh's bounding box
  std::uint64_t content_hash = 0;                          ///< of every value above: names caches, enters scenario_hash
};

/// What part.yaml (or an inline `part: {mesh: .., density: ..}`) may say.
struct PartSpec {
  std::string name;
  std::string mesh;                ///< path
  std::string envelope;            ///< path, optional
  std::string pieces;              ///< path of an OBJ whose objects are convex pieces, optional
  std::string unit;                ///< of the mesh files; empty: mm
  double chord_tolerance = 1e-4;   ///< m, STEP only
  double scale = 1;                ///< of the shapes in the files, about their origin
  double density = 2700;           ///< kg/m^3, aluminium
  double mass = 0;                 ///< kg; 0: from volume and density. Needed when the mesh is open.
  double friction = 0.4;
  double restitution = 0.1;
  Material surface;
  SymmetrySpec symmetry{"auto"};  ///< found from the envelope unless stated

  void visit(ConfigVisitor& v);
  void validate() const;
};

/// Reads part.yaml. Paths inside are relative to it.
PartSpec read_part_spec(const std::string& path);

/// Loads meshes and computes the rest. Throws AssetError or SpecError.
Part load_part(const PartSpec& spec);

}  // namespace binpick

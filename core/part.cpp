#include "core/part.hpp"

#include <cmath>
#include <filesystem>

#include "core/convex_hull.hpp"
#include "core/error.hpp"
#include "core/hash.hpp"
#include "core/mesh_io.hpp"
#include "core/mesh_repair.hpp"
#include "core/quantity.hpp"
#include "core/symmetry_detection.hpp"
#include "core/yaml.hpp"

namespace binpick {
namespace {

constexpr double kLeastVolume = 1e-9;      // of the cube of the diameter: folded sheets enclose rounding only
constexpr double kConvexTolerance = 1e-6;  // of the diameter: float coordinates

void require(bool good, const std::string& key, double value, const std::string& range) {
  if (!good) throw SpecError(key + ": " + format_double(value) + " must lie in " + range);
}

void add(Hasher& hasher, const TriangleMesh& mesh) {
  hasher.add(std::uint64_t{mesh.vertices.size()}).add(std::uint64_t{mesh.triangles.size()});
  for (const Eigen::Vector3d& v : mesh.vertices) hasher.add(v.x()).add(v.y()).add(v.z());
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t) hasher.add(std::uint64_t{corner});
  }
}

std::uint64_t hash_of(const Part& part) {
  Hasher hasher;
  hasher.add(std::string_view(part.name));
  add(hasher, part.mesh_P);
  add(hasher, part.envelope_P);
  hasher.add(std::uint64_t{part.pieces_P.size()});
  for (const TriangleMesh& piece : part.pieces_P) add(hasher, piece);
  hasher.add(part.density).add(part.friction).add(part.restitution).add(part.diameter);
  hasher.add(part.surface.albedo).add(part.surface.specular).add(part.surface.roughness);
  hasher.add(std::uint64_t{part.symmetry.finite.size()}).add(std::uint64_t{part.symmetry.axis.has_value()});
  for (const Pose& member : part.symmetry.finite) hasher.add(member);
  if (part.symmetry.axis) {
    for (const Eigen::Vector3d& v : {part.symmetry.axis->direction_P, part.symmetry.axis->point_P}) {
      hasher.add(v.x()).add(v.y()).add(v.z());
    }
  }
  hasher.add(part.mass.volume).add(part.mass.mass);
  for (Eigen::Index k = 0; k < 3; ++k) hasher.add(part.mass.center_P[k]).add(part.box_center_P[k]);
  for (Eigen::Index k = 0; k < 9; ++k) hasher.add(part.mass.inertia_P(k));
  return hasher.value();
}

bool encloses_volume(const TriangleMesh& mesh) {
  return signed_volume(mesh) > kLeastVolume * std::pow(mesh_diameter(mesh), 3);
}

/// Every piece closed and convex: each vertex on or below the plane of each triangle.
void check_pieces(const std::vector<TriangleMesh>& pieces, const std::string& path) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const TriangleMesh& piece = pieces[i];
    const std::string place = path + ": object " + std::to_string(i + 1);
    if (!is_closed(piece)) throw AssetError(place + " is not closed");
    if (!encloses_volume(piece)) throw AssetError(place + " encloses no volume");
    const double tolerance = kConvexTolerance * mesh_diameter(piece);
    for (const auto& t : piece.triangles) {
      const Eigen::Vector3d& a = piece.vertices[t[0]];
      const Eigen::Vector3d normal = (piece.vertices[t[1]] - a).cross(piece.vertices[t[2]] - a).stableNormalized();
      for (const Eigen::Vector3d& v : piece.vertices) {
        if (normal.dot(v - a) > tolerance) throw AssetError(place + " is not convex");
      }
    }
  }
}

/// An open mesh has no inside: its hull stands in for collision and mass, and the mass must be told.
void set_envelope(Part& part, const PartSpec& spec, const MeshReadOptions& options) {
  const std::string& path = spec.envelope.empty() ? spec.mesh : spec.envelope;
  part.envelope_P = spec.envelope.empty() ? part.mesh_P : read_mesh(spec.envelope, options);
  if (is_closed(part.envelope_P)) {
    if (!encloses_volume(part.envelope_P)) throw AssetError(path + ": the mesh is closed but encloses no volume");
    return;
  }
  if (!(spec.mass > 0)) {
    throw AssetError(path +
                     ": the mesh is not closed, so its mass cannot be computed: state `mass:` or close the mesh");
  }
  part.envelope_P = convex_hull(part.envelope_P.vertices);
  if (part.envelope_P.empty() || !encloses_volume(part.envelope_P)) {
    throw AssetError(path + ": the mesh is flat and encloses no volume");
  }
}

}  // namespace

void PartSpec::visit(ConfigVisitor& v) {
  v.field("name", name, "name in records and reports; empty: the name of the mesh file");
  v.path("mesh", mesh, "CAD file: .stl, .obj, .ply, .step, .stp");
  v.path("envelope", envelope, "outer envelope for collision and mass; empty: the mesh itself");
  v.path("pieces", pieces,
         "OBJ file whose objects are convex pieces of the envelope; empty: decomposed by the simulator");
  v.choice("unit", unit, {"", "mm", "cm", "m", "inch"},
           "length unit of STL, OBJ and PLY; empty: mm (STEP has its own)");
  v.field("chord_tolerance", chord_tolerance, Unit::kLength, "largest distance of a STEP facet from its surface");
  // What leaves the shape alone is not written, so that older scenes keep their hash.
  if (v.reading() || scale != 1) v.field("scale", scale, Unit::kNone, "of the shapes in the files, about their origin");
  v.field("density", density, Unit::kDensity, "gives the mass from the envelope's volume");
  v.field("mass", mass, Unit::kMass, "0: from the density; must be stated when the mesh is open");
  v.field("friction", friction, Unit::kNone, "Coulomb coefficient of the part's surface");
  v.field("restitution", restitution, Unit::kNone, "coefficient of restitution of the part's surface");
  v.section("surface", surface, "how it returns light");
  v.section("symmetry", symmetry, "rotations that carry the part into itself");
}

void PartSpec::validate() const {
  if (mesh.empty()) throw SpecError("mesh: a part needs a CAD file");
  require(chord_tolerance >= 1e-6 && chord_tolerance <= 0.01, "chord_tolerance", chord_tolerance, "0.000001 .. 0.01 m");
  require(scale >= 0.01 && scale <= 100, "scale", scale, "0.01 .. 100");
  require(density >= 1 && density <= 25000, "density", density, "1 .. 25000 kg/m^3");
  require(mass >= 0 && mass <= 1000, "mass", mass, "0 .. 1000 kg");
  require(friction >= 0 && friction <= 2, "friction", friction, "0 .. 2");
  require(restitution >= 0 && restitution <= 1, "restitution", restitution, "0 .. 1");
  surface.validate();
  symmetry.validate();
}

PartSpec read_part_spec(const std::string& path) {
  PartSpec spec = read_config_file<PartSpec>(path);  // misspelt keys first, then what the values say
  try {
    spec.validate();
  } catch (const SpecError& error) {
    throw SpecError(path + ": " + error.what());
  }
  return spec;
}

Part load_part(const PartSpec& spec) {
  spec.validate();
  const MeshReadOptions options{spec.unit, spec.chord_tolerance, spec.scale};
  Part part;
  part.name = spec.name.empty() ? std::filesystem::path(spec.mesh).stem().string() : spec.name;
  part.mesh_P = read_mesh(spec.mesh, options);
  set_envelope(part, spec, options);
  if (!spec.pieces.empty()) {
    part.pieces_P = read_mesh_objects(spec.pieces, options);
    check_pieces(part.pieces_P, spec.pieces);
  }
  part.mass = mass_properties(part.envelope_P, spec.density);
  part.density = spec.density;
  if (spec.mass > 0) {
    part.density = spec.mass / part.mass.volume;
    part.mass = mass_properties(part.envelope_P, part.density);
    part.mass.mass = spec.mass;
  }
  part.friction = spec.friction;
  part.restitution = spec.restitution;
  part.surface = spec.surface;
  part.symmetry = spec.symmetry.type == "auto" ? detect_symmetry(part.envelope_P, spec.symmetry.tolerance)
                                               : make_symmetry(spec.symmetry);
  part.diameter = mesh_diameter(part.mesh_P);
  part.box_center_P = bounding_box(part.mesh_P).center();
  part.content_hash = hash_of(part);
  return part;
}

}  // namespace binpick

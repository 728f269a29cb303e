// binpick part PART: what the testbed makes of a CAD part: mesh, mass, convex pieces and their error, resting poses,
// symmetry; as a table, JSON and one picture.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/quantity.hpp"
#include "sim/convex_decomposition.hpp"
#include "sim/part_sheet.hpp"
#include "sim/shape_error.hpp"
#include "tools/commands.hpp"

namespace binpick {
namespace {

struct Options {
  std::string part, png, json, unit, density, mass;
  bool decompose = false;
};

/// Everything that is told.
struct Facts {
  Part part;
  bool closed = false;        ///< the mesh as drawn
  bool given = false;         ///< pieces of part.yaml
  Eigen::Vector3d principal;  ///< kg m^2, about the mass centre, ascending
  CollisionShape shape;
  ShapeError error;
  std::vector<StablePose> poses;
};

PartSpec spec_of(const Options& options) {
  namespace fs = std::filesystem;
  std::string path = options.part;
  if (fs::is_directory(path)) path = (fs::path(path) / "part.yaml").string();
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".yaml" || extension == ".yml") {
    if (!options.unit.empty() || !options.density.empty() || !options.mass.empty())
      throw SpecError(path + ": unit, density and mass of a part file stand in the file, not on the command line");
    return read_part_spec(path);
  }
  PartSpec spec;
  spec.mesh = path;
  spec.unit = options.unit;
  if (!options.density.empty()) spec.density = parse_quantity(options.density, Unit::kDensity);
  if (!options.mass.empty()) spec.mass = parse_quantity(options.mass, Unit::kMass);
  return spec;
}

Facts facts_of(const Options& options) {
  Facts facts;
  facts.part = load_part(spec_of(options));
  if (options.decompose) facts.part.pieces_P.clear();
  facts.closed = is_closed(facts.part.mesh_P);
  facts.given = !facts.part.pieces_P.empty();
  facts.principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(facts.part.mass.inertia_P).eigenvalues();
  facts.shape = collision_shape(facts.part);
  facts.error = shape_error(facts.part.envelope_P, facts.shape.pieces_P);
  facts.poses = stable_poses(facts.part.mesh_P.vertices, facts.part.mass.center_P, facts.part.symmetry);
  return facts;
}

std::string text(const char* format, auto... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

std::size_t vertex_count(const std::vector<TriangleMesh>& pieces) {
  std::size_t count = 0;
  for (const TriangleMesh& piece : pieces) count += piece.vertices.size();
  return count;
}

/// A line for each kind of turn.
std::vector<std::string> symmetry_column(const Symmetry& symmetry) {
  std::vector<std::string> column = {"Symmetry"};
  std::stringstream words(symmetry_in_words(symmetry));
  for (std::string line; std::getline(words, line, ';');) column.push_back(line.substr(line.find_first_not_of(' ')));
  return column;
}

/// What would be printed as -0.00 mm is 0.
Eigen::Vector3d without_rounding(const Eigen::Vector3d& p) { return (p.array().abs() < 5e-6).select(0.0, p); }

/// Lines under headings: the table of the terminal, and the text of the picture.
std::vector<std::vector<std::string>> columns_of(const Facts& f) {
  const Part& p = f.part;
  const Eigen::Vector3d size = bounding_box(p.mesh_P).sizes() * 1e3, center = without_rounding(p.mass.center_P) * 1e3;
  const Eigen::Vector3d inertia = f.principal * 1e6;
  const ShapeError& e = f.error;
  return {{"Mesh", text("%.1f x %.1f x %.1f mm", size.x(), size.y(), size.z()),
           text("diameter %.1f mm", 1e3 * p.diameter), text("%zu triangles", p.mesh_P.triangles.size()),
           f.closed ? "closed" : "OPEN: its hull stands in", text("volume %.3f cm3", 1e6 * p.mass.volume)},
          {"Mass", text("%.1f g, %.0f kg/m3", 1e3 * p.mass.mass, p.density),
           text("centre %.2f %.2f %.2f mm", center.x(), center.y(), center.z()), "principal moments",
           text("%.4g %.4g %.4g kg mm2", inertia.x(), inertia.y(), inertia.z())},
          {"Convex pieces",
           text("%zu, %s, %zu corners", f.shape.pieces_P.size(), f.given ? "given" : "decomposed",
                vertex_count(f.shape.pieces_P)),
           text("volume error %.2f +- %.2f %%", 100 * e.volume_error(), 100 * e.standard_error),
           text("too much %.2f %%, missing %.2f %%", 100 * e.extra, 100 * e.missing),
           text("Hausdorff %.2f mm", 1e3 * e.hausdorff()),
           text("part to pieces %.2f, back %.2f mm", 1e3 * e.solid_to_pieces, 1e3 * e.pieces_to_solid)},
          symmetry_column(p.symmetry)};
}

void print(const Facts& f) {
  std::printf("%s\n", f.part.name.c_str());
  for (const std::vector<std::string>& column : columns_of(f))
    for (std::size_t i = 1; i < column.size(); ++i)
      std::printf("  %-14s %s\n", i == 1 ? column[0].c_str() : "", column[i].c_str());
  std::printf("  %-14s share %%  faces  centre mm  topples at deg  down (in P)\n", "Resting poses");
  for (const StablePose& pose : f.poses)
    std::printf("  %-14s %7.2f %6d %10.2f %15.1f  (%.3f %.3f %.3f)\n", "", 100 * pose.probability, pose.faces,
                1e3 * pose.height, pose.tilt * 180 / std::numbers::pi, pose.down_P.x() + 0.0, pose.down_P.y() + 0.0,
                pose.down_P.z() + 0.0);
}

nlohmann::ordered_json json_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::ordered_json json_of(const Facts& f) {
  const Part& p = f.part;
  const ShapeError& e = f.error;
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["name"] = p.name;
  json["mesh"] = {{"triangles", p.mesh_P.triangles.size()},
                  {"closed", f.closed},
                  {"size_m", json_of(Eigen::Vector3d(bounding_box(p.mesh_P).sizes()))},
                  {"diameter_m", p.diameter},
                  {"volume_m3", p.mass.volume}};
  json["mass"] = {{"mass_kg", p.mass.mass},
                  {"density_kg_m3", p.density},
                  {"center_m", json_of(p.mass.center_P)},
                  {"principal_moments_kg_m2", json_of(f.principal)}};
  json["pieces"] = {{"count", f.shape.pieces_P.size()},
                    {"given", f.given},
                    {"vertices", vertex_count(f.shape.pieces_P)},
                    {"volume_error", e.volume_error()},
                    {"standard_error", e.standard_error},
                    {"extra", e.extra},
                    {"missing", e.missing},
                    {"hausdorff_m", e.hausdorff()},
                    {"part_to_pieces_m", e.solid_to_pieces},
                    {"pieces_to_part_m", e.pieces_to_solid}};
  json["stable_poses"] = nlohmann::ordered_json::array();
  for (const StablePose& pose : f.poses)
    json["stable_poses"].push_back({{"probability", pose.probability},
                                    {"faces", pose.faces},
                                    {"down_P", json_of(pose.down_P)},
                                    {"height_m", pose.height},
                                    {"topples_at_rad", pose.tilt}});
  json["symmetry"] = {{"words", symmetry_in_words(p.symmetry)}, {"axes", nlohmann::ordered_json::array()}};
  for (const SymmetryAxis& axis : symmetry_axes(p.symmetry))
    json["symmetry"]["axes"].push_back(
        {{"direction_P", json_of(axis.direction_P)}, {"point_P_m", json_of(axis.point_P)}, {"order", axis.order}});
  return json;
}

int run(const Options& options) {
  const Facts facts = facts_of(options);
  print(facts);
  if (!options.json.empty()) write_file(options.json, json_of(facts).dump(2) + "\n");
  if (!options.png.empty()) {
    const auto renderer = make_renderer("osmesa");
    write_png(options.png, part_sheet({facts.part, facts.shape, facts.poses, columns_of(facts)}, *renderer));
  }
  std::fflush(stdout);
  if (std::ferror(stdout)) throw StorageError("standard output: cannot write");
  return 0;
}

}  // namespace

Action add_part(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("part", "a CAD part as the testbed sees it: pieces, resting poses, symmetry");
  command->add_option("part", options->part, "folder of a part, its part.yaml, or a mesh or STEP file")->required();
  command->add_option("--png", options->png, "file for the picture");
  command->add_option("--json", options->json, "file for the figures");
  command->add_flag("--decompose", options->decompose, "convex pieces of our own instead of the part's");
  command->add_option("--unit", options->unit, "of a bare STL, OBJ or PLY file (mm)");
  command->add_option("--density", options->density, "of a bare file (2700 kg/m^3)");
  command->add_option("--mass", options->mass, "of a bare file; an open mesh needs it");
  return [options] { return run(*options); };
}

}  // namespace binpick

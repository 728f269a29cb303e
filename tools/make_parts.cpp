// make_parts OUTDIR [--bins FOLDER]: writes our own CAD, one folder per part: STEP (the drawing), STL (the same surface
// in triangles, quick to load), convex pieces for the simulator and part.yaml. The tracked files in assets/parts are
// its output.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include "core/file_io.hpp"
#include "core/mesh_io.hpp"
#include "core/quantity.hpp"
#include "tools/cad_bins.hpp"
#include "tools/cad_dimensions.hpp"
#include "tools/cad_pieces.hpp"
#include "tools/cad_shapes.hpp"

namespace {

using namespace binpick;

// m: facets of the STL files lie within 0.1 mm of the drawing. With 0.096 mm the bearing gets an even number of sides,
// so that its bounding box is centred on its axis.
constexpr double kChord = 9.6e-5;
constexpr int kEnvelopeFacets = 96;  // 0.027 mm from the circle of 50 mm

void write_pieces(const std::string& path, const std::vector<TriangleMesh>& pieces) {
  std::string text = "# convex pieces, millimetres\n";
  std::size_t first = 1;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    text += "o piece_" + std::to_string(i) + "\n";
    for (const Eigen::Vector3d& v : pieces[i].vertices) {
      char line[100];  // a tenth of a nanometre: more digits say nothing
      std::snprintf(line, sizeof line, "v %.7f %.7f %.7f\n", 1000 * v.x(), 1000 * v.y(), 1000 * v.z());
      text += line;
    }
    for (const auto& t : pieces[i].triangles) {
      text += "f " + std::to_string(first + t[0]) + " " + std::to_string(first + t[1]) + " " +
              std::to_string(first + t[2]) + "\n";
    }
    first += pieces[i].vertices.size();
  }
  write_file(path, text);
}

/// Triangles of the drawing: the STEP file is read back as a user's would be.
void write_triangles(const std::string& folder, const std::string& name) {
  write_stl(folder + "/" + name + ".stl", read_mesh(folder + "/" + name + ".step", {"", kChord}));
}

/// What every part.yaml of ours ends with, and what stands before it.
struct Sheet {
  std::string comment;  ///< lines with their #
  std::string envelope;
  std::string pieces;  ///< what they are
  std::string symmetry;
};

void write_sheet(const std::string& folder, const std::string& name, const Sheet& sheet) {
  std::string mesh = "mesh: " + name + ".stl";
  mesh.resize(std::max<std::size_t>(mesh.size() + 1, 28), ' ');
  write_file(folder + "/part.yaml",
             sheet.comment + "name: " + name + "\n" + mesh + "# " + name + ".step is the same shape, slower to load\n" +
                 sheet.envelope + "pieces: pieces.obj          # " + sheet.pieces +
                 "\n"
                 "density: 2700\n"
                 "friction: 0.4\n"
                 "restitution: 0.1\n"
                 "surface: {albedo: 0.25, specular: 0.4, roughness: 0.35}   # machined aluminium (untuned against any "
                 "measurement)\n"
                 "symmetry:\n" +
                 sheet.symmetry);
}

void make_bearing(const std::string& folder) {
  using namespace bearing;
  write_bearing_step(folder + "/bearing_6914.step");
  write_triangles(folder, "bearing_6914");
  write_stl(folder + "/envelope.stl",
            ring_envelope(kInnerRadius / 1000, kOuterRadius / 1000, kWidth / 1000, kEnvelopeFacets));
  write_pieces(folder + "/pieces.obj", bearing_pieces());
  write_sheet(
      folder, "bearing_6914",
      {"# Sealed ball bearing 6914: bore 70, outside 100, width 16 mm. Axis z, origin in the centre. Rings and seals\n"
       "# close it on every side; the balls and the cage inside are drawn, but no camera sees them.\n"
       "# The envelope's 64.09 cm^3 of aluminium weigh 0.173 kg.\n",
       "envelope: envelope.stl      # ring of rectangular section, volume true\n", "twelve wedges",
       "  type: revolution\n"
       "  axis: [0, 0, 1]\n"
       "  flip: true                # both faces are alike\n"});
}

void make_bracket(const std::string& folder) {
  write_bracket_step(folder + "/bracket_l.step");
  write_triangles(folder, "bracket_l");
  write_pieces(folder + "/pieces.obj", bracket_pieces());
  write_sheet(
      folder, "bracket_l",
      {"# L-bracket 90 x 60 x 60 mm of 8 mm plate with three holes and a boss. Origin at the outer corner, base "
       "plate\n"
       "# on z = 0, upright along x = 0. No rotation carries it into itself.\n",
       "", "two plates and the boss; the holes are left closed", "  type: none\n"});
}

void make_tee(const std::string& folder) {
  write_tee_step(folder + "/tee.step");
  write_triangles(folder, "tee");
  write_pieces(folder + "/pieces.obj", tee_pieces());
  write_sheet(
      folder, "tee",
      {"# Flat T-piece 64 x 60 x 16 mm: bar along x, stem towards -y, 16 mm thick along z. Origin in the middle "
       "of its\n"
       "# bounding box. The half turn about the stem swaps both arms and both faces; there is no other.\n",
       "", "bar and stem",
       "  type: cyclic\n"
       "  axis: [0, 1, 0]\n"
       "  order: 2\n"});
}

void make_bolt(const std::string& folder) {
  write_bolt_step(folder + "/bolt_m24x80.step");
  write_triangles(folder, "bolt_m24x80");
  write_pieces(folder + "/pieces.obj", bolt_pieces());
  write_sheet(folder, "bolt_m24x80",
              {"# Hexagon bolt M24 x 80: head 36 mm across flats and 15 mm high, shank 24 mm. Axis z, origin under the "
               "head,\n"
               "# shank towards +z. The thread is drawn as a plain cylinder of the major diameter.\n",
               "", "head and shank",
               "  type: cyclic\n"
               "  axis: [0, 0, 1]\n"
               "  order: 6\n"});
}

void make_gear(const std::string& folder) {
  write_gear_step(folder + "/gear_m3_z24.step");
  write_triangles(folder, "gear_m3_z24");
  write_pieces(folder + "/pieces.obj", gear_pieces());
  write_sheet(folder, "gear_m3_z24",
              {"# Spur gear, module 3, 24 involute teeth, 20 mm wide, plain bore of 20 mm. Axis z, origin in the "
               "centre, a tooth\n"
               "# on x. No hub and no keyway, so that both faces are alike and every tooth is.\n",
               "", "one a tooth, from the bore to its tip",
               "  type: dihedral\n"
               "  axis: [0, 0, 1]\n"
               "  perpendicular: [1, 0, 0]\n"
               "  order: 24\n"});
}

void make_plate(const std::string& folder) {
  write_plate_step(folder + "/plate_100x60.step");
  write_triangles(folder, "plate_100x60");
  write_pieces(folder + "/pieces.obj", plate_pieces());
  write_sheet(folder, "plate_100x60",
              {"# Plate 100 x 60 x 4 mm with two holes of 14 mm on its long axis and a slot of 10 x 36 mm across its "
               "middle.\n"
               "# Origin in the centre. Half turns about x, y and z carry it into itself.\n",
               "", "ten blocks; the holes are squares of the same area",
               "  type: dihedral\n"
               "  axis: [0, 0, 1]\n"
               "  perpendicular: [1, 0, 0]\n"
               "  order: 2\n"});
}

void make_shaft(const std::string& folder) {
  write_shaft_step(folder + "/shaft_25_35x120.step");
  write_triangles(folder, "shaft_25_35x120");
  write_pieces(folder + "/pieces.obj", shaft_pieces());
  write_sheet(
      folder, "shaft_25_35x120",
      {"# Stepped shaft 120 mm long: 35 mm thick for z < 0, 25 mm for z > 0. Axis z, origin in the middle of its "
       "length.\n"
       "# Turned upside down it is another: 5 mm between the halves.\n",
       "", "both halves",
       "  type: revolution\n"
       "  axis: [0, 0, 1]\n"
       "  flip: false\n"});
}

void make_part(const std::string& out, const std::string& name, void (*make)(const std::string&)) {
  const std::string folder = out + "/" + name;
  make_folder(folder);
  make(folder);
}

void make_bins(const std::string& folder) {
  make_folder(folder);
  write_tote_step(folder + "/tote_400x300.step");
  write_triangles(folder, "tote_400x300");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Writes the CAD of our own parts"};
  std::string out, bins;
  app.add_option("OUTDIR", out, "folder that gets one folder per part")->required();
  app.add_option("--bins", bins, "folder that gets our bins as well (assets/bins)");
  CLI11_PARSE(app, argc, argv);
  try {
    make_part(out, "bearing_6914", make_bearing);
    make_part(out, "bracket_l", make_bracket);
    make_part(out, "tee", make_tee);
    make_part(out, "bolt_m24x80", make_bolt);
    make_part(out, "gear_m3_z24", make_gear);
    make_part(out, "plate_100x60", make_plate);
    make_part(out, "shaft_25_35x120", make_shaft);
    if (!bins.empty()) make_bins(bins);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_parts: %s\n", error.what());
    return 2;
  }
  return 0;
}

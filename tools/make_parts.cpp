// make_parts OUTDIR: writes our own CAD, one folder per part: STEP (the drawing), STL (the same surface in triangles,
// quick to load), convex pieces for the simulator and part.yaml. The tracked files in assets/parts are its output.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "core/file_io.hpp"
#include "core/mesh_io.hpp"
#include "core/quantity.hpp"
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

void make_bearing(const std::string& folder) {
  using namespace bearing;
  write_bearing_step(folder + "/bearing_6914.step");
  write_triangles(folder, "bearing_6914");
  write_stl(folder + "/envelope.stl",
            ring_envelope(kInnerRadius / 1000, kOuterRadius / 1000, kWidth / 1000, kEnvelopeFacets));
  write_pieces(folder + "/pieces.obj", bearing_pieces());
  write_file(
      folder + "/part.yaml",
      "# Sealed ball bearing 6914: bore 70, outside 100, width 16 mm. Axis z, origin in the centre. Rings and seals\n"
      "# close it on every side; the balls and the cage inside are drawn, but no camera sees them.\n"
      "# The envelope's 64.09 cm^3 of aluminium weigh 0.173 kg.\n"
      "name: bearing_6914\n"
      "mesh: bearing_6914.stl      # bearing_6914.step is the same shape, slower to load\n"
      "envelope: envelope.stl      # ring of rectangular section, volume true\n"
      "pieces: pieces.obj          # eight wedges\n"
      "density: 2700\n"
      "friction: 0.4\n"
      "restitution: 0.1\n"
      "symmetry:\n"
      "  type: revolution\n"
      "  axis: [0, 0, 1]\n"
      "  flip: true                # both faces are alike\n");
}

void make_bracket(const std::string& folder) {
  write_bracket_step(folder + "/bracket_l.step");
  write_triangles(folder, "bracket_l");
  write_pieces(folder + "/pieces.obj", bracket_pieces());
  write_file(
      folder + "/part.yaml",
      "# L-bracket 90 x 60 x 60 mm of 8 mm plate with three holes and a boss. Origin at the outer corner, base plate\n"
      "# on z = 0, upright along x = 0. No rotation carries it into itself.\n"
      "name: bracket_l\n"
      "mesh: bracket_l.stl         # bracket_l.step is the same shape, slower to load\n"
      "pieces: pieces.obj          # two plates and the boss; the holes are left closed\n"
      "density: 2700\n"
      "friction: 0.4\n"
      "restitution: 0.1\n"
      "symmetry:\n"
      "  type: none\n");
}

void make_tee(const std::string& folder) {
  write_tee_step(folder + "/tee.step");
  write_triangles(folder, "tee");
  write_pieces(folder + "/pieces.obj", tee_pieces());
  write_file(
      folder + "/part.yaml",
      "# Flat T-piece 64 x 60 x 16 mm: bar along x, stem towards -y, 16 mm thick along z. Origin in the middle of its\n"
      "# bounding box. The half turn about the stem swaps both arms and both faces; there is no other.\n"
      "name: tee\n"
      "mesh: tee.stl               # tee.step is the same shape, slower to load\n"
      "pieces: pieces.obj          # bar and stem\n"
      "density: 2700\n"
      "friction: 0.4\n"
      "restitution: 0.1\n"
      "symmetry:\n"
      "  type: cyclic\n"
      "  axis: [0, 1, 0]\n"
      "  order: 2\n");
}

void make_part(const std::string& out, const std::string& name, void (*make)(const std::string&)) {
  const std::string folder = out + "/" + name;
  make_folder(folder);
  make(folder);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Writes the CAD of our own parts"};
  std::string out;
  app.add_option("OUTDIR", out, "folder that gets one folder per part")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    make_part(out, "bearing_6914", make_bearing);
    make_part(out, "bracket_l", make_bracket);
    make_part(out, "tee", make_tee);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_parts: %s\n", error.what());
    return 2;
  }
  return 0;
}

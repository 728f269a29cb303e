#include "core/mesh_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/error.hpp"
#include "core/mesh_properties.hpp"
#include "core/random.hpp"
#include "mesh_samples.hpp"
#include "temp_folder.hpp"

namespace binpick {
namespace {

using samples::with;

void expect_block(const TriangleMesh& mesh, double tolerance, double scale = 1) {
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  const MassProperties m = mass_properties(mesh, 1);
  EXPECT_NEAR(m.volume / std::pow(scale, 3), 4.8e-5, 4.8e-5 * tolerance);
  EXPECT_LT((m.center_P / scale - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 0.06 * tolerance);
  EXPECT_NEAR(mesh_diameter(mesh) / scale, std::sqrt(0.0056), 0.06 * tolerance);
}

constexpr double kFloat = 1e-6;  // coordinates that went through float

class MeshIo : public testing::Test {
 protected:
  TriangleMesh read(const std::string& name, const std::string& bytes, const std::string& unit = "") {
    return read_mesh(folder_.put(name, bytes), {unit, 1e-4}, &report_);
  }
  TempFolder folder_;
  MeshReadReport report_;
};

TEST_F(MeshIo, EveryFormatGivesTheSameBlock) {
  for (const auto& [name, bytes] :
       std::vector<std::pair<std::string, std::string>>{{"binary.stl", samples::binary_stl()},
                                                        {"ascii.stl", samples::ascii_stl()},
                                                        {"a.obj", samples::obj()},
                                                        {"ascii.ply", samples::ascii_ply()},
                                                        {"little.ply", samples::binary_ply(false)},
                                                        {"big.ply", samples::binary_ply(true)},
                                                        {"UPPER.STL", samples::binary_stl()}}) {
    SCOPED_TRACE(name);
    expect_block(read(name, bytes), kFloat);
    EXPECT_TRUE(report_.closed);
    EXPECT_EQ(report_.dropped_triangles, 0u);
    EXPECT_FALSE(report_.turned_inside_out);
  }
}

TEST_F(MeshIo, ObjNumbersMayBeginWithTheirPoint) {
  std::string text = samples::obj();
  const std::string first = "v " + samples::mm(samples::block().vertices[0]) + "\n";  // -20 0 20
  text = with(text, first, "v -.2e2 .0 +.02e3\n");
  expect_block(read("a.obj", text), kFloat);
}

// The importer takes a VERTEX for a vertex, strips for faces, the first format line, and a line end among the data for
// one of the header: each ended in a crash.
TEST_F(MeshIo, APlyIsWhatOurOwnHeaderReaderSaysItIs) {
  const std::string text = samples::ascii_ply(), face = "element face 12", first_face = "\n3 ";
  const auto with_element = [&](const std::string& element, const std::string& data) {
    return with(with(text, face, element + "\n" + face), first_face, "\n" + data + first_face);
  };
  std::string line_end_first = samples::binary_ply(false);
  line_end_first[line_end_first.find("end_header\n") + 11] = '\n';  // 20 nm off
  for (const std::string& bytes :
       {with_element("element VERTEX 1\nproperty float x", "7"),
        with_element("element tristrips 1\nproperty list int int vertex_indices", "5 0 1 99 -1 1000000"),
        with(text, "format ascii 1.0", "format binary_little_endian 1.0\nformat ascii 1.0"), line_end_first}) {
    SCOPED_TRACE(bytes.substr(0, 200));
    expect_block(read("a.ply", bytes), kFloat);
  }
}

TEST_F(MeshIo, WritesWhatItReads) {
  write_stl(folder_.at("a.stl"), samples::block());
  expect_block(read_mesh(folder_.at("a.stl")), kFloat);
  write_ply(folder_.at("a.ply"), samples::block());
  expect_block(read_mesh(folder_.at("a.ply")), kFloat);
}

TEST_F(MeshIo, UnitsScale) {
  expect_block(read("a.stl", samples::binary_stl(1), "m"), kFloat);
  expect_block(read("a.stl", samples::binary_stl(100), "cm"), kFloat);
  expect_block(read("a.stl", samples::binary_stl(1 / 0.0254), "inch"), kFloat);
  expect_block(read("a.stl", samples::binary_stl(1000), "mm"), kFloat);
  expect_block(read("a.stl", samples::binary_stl(1000), "cm"), kFloat, 10);
}

TEST_F(MeshIo, BinaryStlThatCallsItselfSolid) {
  std::string bytes = samples::binary_stl();
  bytes.replace(0, 24, "solid written by a lathe");
  expect_block(read("a.stl", bytes), kFloat);
}

TEST_F(MeshIo, AsciiHabitsOfOtherPrograms) {
  const std::string text = samples::ascii_stl();
  std::string dos;
  for (const char c : text) dos += c == '\n' ? "\r\n" : std::string(1, c);
  expect_block(read("dos.stl", dos), kFloat);
  std::string upper = text;
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  expect_block(read("upper.stl", upper), kFloat);
  expect_block(read("nan.stl", with(text, "normal 0 0 0", "normal nan nan nan")), kFloat);  // a normal only
  expect_block(read("plus.stl", with(text, "vertex 40 40 40", "vertex +4.0E+01 40. 0.4e2")), kFloat);
  const std::size_t half = text.find("  facet", text.size() / 2);
  expect_block(read("two.stl", text.substr(0, half) + "endsolid a\nsolid b\n" + text.substr(half)), kFloat);
}

TEST_F(MeshIo, ObjHabitsOfOtherPrograms) {
  // Quads, texture and normal indices, negative indices, colours, a missing material file.
  const std::string text =
      "mtllib nowhere.mtl\n"
      "v -20 0 20 0.5 0.5 0.5\nv 40 0 20 1 0 0\nv 40 40 20\nv -20 40 20\nv -20 0 40\nv 40 0 40\nv 40 40 40\nv -20 40 "
      "40\n"
      "vt 0 0\nvn 0 0 1\nusemtl steel\ns off\ng sides\n"
      "f 4/1/1 3/1/1 2/1/1 1/1/1\nf 5//1 6//1 7//1 8//1\nf 1 2 6 5\nf 2/1 3/1 7/1 6/1\nf -6 -5 -1 -2\nf 4 1 5 8\n";
  expect_block(read("a.obj", text), kFloat);
}

TEST_F(MeshIo, RepairsAreCounted) {
  const std::string facet =
      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\nendloop\nendfacet\n";
  const std::string text = samples::ascii_stl();
  expect_block(read("zero.stl", with(text, "solid block\n", "solid block\n" + facet)), kFloat);
  EXPECT_EQ(report_.dropped_triangles, 1u);
  const std::size_t first = text.find("  facet");
  const std::string again = text.substr(first, text.find("  facet", first + 1) - first);
  expect_block(read("twice.stl", with(text, "solid block\n", "solid block\n" + again)), kFloat);
  EXPECT_EQ(report_.dropped_triangles, 1u);
  EXPECT_EQ(report_.merged_vertices, 39u - 8u);  // 13 facets of 3 corners on 8 points
}

TEST_F(MeshIo, InsideOutIsTurned) {
  std::string text = samples::ascii_ply();
  TriangleMesh mesh = samples::block();
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  write_ply(folder_.at("a.ply"), mesh);
  expect_block(read_mesh(folder_.at("a.ply"), {}, &report_), kFloat);
  EXPECT_TRUE(report_.turned_inside_out);
}

TEST_F(MeshIo, MixedOrientationIsTurned) {
  const Seed seed = Seed{1}.child("mixed-orientation");
  for (std::uint64_t i = 0; i < 20; ++i) {
    SCOPED_TRACE("item " + std::to_string(i));
    Rng rng = seed.rng().at(i);
    TriangleMesh mesh = mesh_of(Primitive::cylinder(0.03, 0.05), 16);
    append(mesh, mesh_of(Primitive::box({0.02, 0.02, 0.02}, Pose(Eigen::Translation3d(0.1, 0, 0)))));
    const double volume = mass_properties(mesh, 1).volume;
    std::size_t turned = 0;
    for (auto& t : mesh.triangles) {
      if (rng.uniform() > 0.2) continue;
      std::swap(t[0], t[1]);
      ++turned;
    }
    write_ply(folder_.at("a.ply"), mesh);
    const MassProperties found = mass_properties(read_mesh(folder_.at("a.ply"), {}, &report_), 1);
    EXPECT_TRUE(report_.closed);
    EXPECT_EQ(report_.turned_triangles, turned);
    EXPECT_NEAR(found.volume, volume, 1e-5 * volume);
  }
}

TEST_F(MeshIo, OpenMeshesAreReadAndReported) {
  const std::string text = samples::ascii_stl();
  const std::size_t first = text.find("  facet");
  const TriangleMesh mesh =
      read("open.stl", with(text, text.substr(first, text.find("  facet", first + 1) - first), ""));
  EXPECT_EQ(mesh.triangles.size(), 11u);
  EXPECT_FALSE(report_.closed);
}

TEST_F(MeshIo, LostDecimalsAreWelded) {
  // One corner of one facet is off by 10 nm, as from a program that prints too few digits.
  const TriangleMesh mesh = read("a.stl", with(samples::ascii_stl(), "vertex 40 40 40", "vertex 40.00001 40 40"));
  EXPECT_TRUE(report_.closed);
  EXPECT_EQ(mesh.vertices.size(), 8u);
}

TEST_F(MeshIo, ObjectsOfAnObjFile) {
  const std::string pieces =
      "o left\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
      "o right\nv 100 0 0\nv 120 0 0\nv 100 20 0\nv 100 0 20\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n";
  const std::vector<TriangleMesh> objects = read_mesh_objects(folder_.put("a.obj", pieces));
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_NEAR(mass_properties(objects[0], 1).volume, 1e-6 / 6, 1e-12);
  EXPECT_NEAR(mass_properties(objects[1], 1).volume, 8e-6 / 6, 1e-12);
  EXPECT_THROW(read_mesh_objects(folder_.put("a.stl", samples::ascii_stl())), AssetError);
}

TEST_F(MeshIo, RandomMeshesSurviveEveryFormat) {
  const Seed seed = Seed{1}.child("round-trip");
  for (std::uint64_t i = 0; i < 20; ++i) {
    SCOPED_TRACE("item " + std::to_string(i));
    Rng rng = seed.rng().at(i);
    const Eigen::Vector3d size(rng.uniform(0.01, 0.5), rng.uniform(0.01, 0.5), rng.uniform(0.01, 0.5));
    Pose X = Pose::Identity();
    X.linear() = rng.rotation().toRotationMatrix();
    X.translation() = 0.2 * rng.unit_vector();
    const TriangleMesh mesh = mesh_of(Primitive::cylinder(size.x(), size.y(), X), 24);
    write_stl(folder_.at("a.stl"), mesh);
    write_ply(folder_.at("a.ply"), mesh);
    const MassProperties expected = mass_properties(mesh, 1);
    for (const char* name : {"a.stl", "a.ply"}) {
      const MassProperties found = mass_properties(read_mesh(folder_.at(name)), 1);
      EXPECT_NEAR(found.volume, expected.volume, 1e-5 * expected.volume);
      EXPECT_LT((found.center_P - expected.center_P).norm(), 1e-6);
      EXPECT_LT((found.inertia_P - expected.inertia_P).norm(), 1e-4 * expected.inertia_P.norm());
    }
  }
}

}  // namespace
}  // namespace binpick

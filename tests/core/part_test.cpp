#include "core/part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "core/error.hpp"
#include "core/mesh_io.hpp"
#include "core/primitive.hpp"
#include "core/random.hpp"
#include "core/yaml.hpp"
#include "mesh_samples.hpp"
#include "temp_folder.hpp"
#include "tools/cad_dimensions.hpp"
#include "tools/cad_pieces.hpp"

namespace binpick {
namespace {

using samples::with;
using testing::HasSubstr;

const std::vector<std::string> kOwnParts = {"bearing_6914", "bracket_l",      "tee", "bolt_m24x80", "gear_m3_z24",
                                            "plate_100x60", "shaft_25_35x120"};

std::string folder_of(const std::string& part) { return std::string(BINPICK_SOURCE_DIR) + "/assets/parts/" + part; }
Part own_part(const std::string& name) { return load_part(read_part_spec(folder_of(name) + "/part.yaml")); }

double volume_of(const std::vector<TriangleMesh>& pieces) {
  double volume = 0;
  for (const TriangleMesh& piece : pieces) volume += mass_properties(piece, 1).volume;
  return volume;
}

/// Largest distance from any vertex and triangle middle of `a` to the surface of `b`.
double worst_distance(const TriangleMesh& a, const TriangleMesh& b) {
  const MeshQuery query(b);
  double worst = 0;
  for (const auto& t : a.triangles) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const auto corner : t) {
      worst = std::max(worst, query.closest(a.vertices[corner], 1)->distance);
      middle += a.vertices[corner] / 3;
    }
    worst = std::max(worst, query.closest(middle, 1)->distance);
  }
  return worst;
}

TEST(OwnParts, BearingHasTheVolumeAndMassOfItsRing) {
  const Part part = own_part("bearing_6914");
  const double volume = std::numbers::pi * (0.05 * 0.05 - 0.035 * 0.035) * 0.016;
  EXPECT_NEAR(part.mass.volume, volume, 1e-6 * volume);
  EXPECT_NEAR(part.mass.mass, 0.173, 0.0005);  // the reference's ring
  EXPECT_NEAR(volume_of(part.pieces_P), volume, 1e-6 * volume);
  // Inertia of the round ring: m (a^2 + b^2) / 2, and half of that + m h^2 / 12.
  const double izz = part.mass.mass * (0.05 * 0.05 + 0.035 * 0.035) / 2;
  EXPECT_NEAR(part.mass.inertia_P(2, 2), izz, 1e-3 * izz);
  EXPECT_NEAR(part.mass.inertia_P(0, 0), izz / 2 + part.mass.mass * 0.016 * 0.016 / 12, 1e-3 * izz);
  EXPECT_LT(part.mass.center_P.norm(), 1e-9);
  EXPECT_LT(part.box_center_P.norm(), 1e-5);
  EXPECT_NEAR(part.diameter, std::hypot(0.1, 2 * 0.0074), 1e-4);  // the chamfer takes 0.6 mm from each rim
  EXPECT_TRUE(part.symmetry.axis.has_value());
  EXPECT_EQ(part.symmetry.finite.size(), 2u);
  EXPECT_EQ(part.pieces_P.size(), 12u);
}

TEST(OwnParts, BearingIsARingFromOutside) {
  const Part part = own_part("bearing_6914");
  const MeshQuery query(part.mesh_P);
  // The land that three cups of 10 mm on a pitch circle of 85 mm need: flat from 37.5 to 47.5 mm, on both faces.
  for (const double side : {1.0, -1.0}) {
    for (double r = 0.0375; r <= 0.0475; r += 0.0001) {
      for (int i = 0; i < 36; ++i) {
        const double angle = 2 * std::numbers::pi * (i + 0.37) / 36;
        const auto hit = query.ray({r * std::cos(angle), r * std::sin(angle), 0.05 * side}, {0, 0, -side}, 1);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->point.z(), 0.008 * side, 1e-9);
        EXPECT_NEAR(hit->normal.z(), side, 1e-9);
      }
    }
  }
  // Something is inside, and no ray from outside meets it: each stops within the chamfer of the envelope.
  const MeshQuery envelope(part.envelope_P);
  const Seed seed = Seed{1}.child("bearing-outside");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Rng rng = seed.rng().at(i);
    const Eigen::Vector3d from = 0.3 * rng.unit_vector();
    const Eigen::Vector3d toward = 0.05 * rng.unit_vector() - from;
    if (const auto hit = query.ray(from, toward.normalized(), 1)) {
      EXPECT_LT(envelope.closest(hit->point, 1)->distance, 0.0006) << "item " << i;
    }
  }
  EXPECT_TRUE(query.closest({0.0425, 0, 0}, 0.0046)) << "the ball on the x axis";
}

TEST(OwnParts, BracketIsTheOneOfItsDrawing) {
  const Part part = own_part("bracket_l");
  EXPECT_LT((bounding_box(part.mesh_P).min()).norm(), 1e-7);
  EXPECT_LT((bounding_box(part.mesh_P).max() - Eigen::Vector3d(0.09, 0.06, 0.06)).norm(), 1e-7);
  double holes = 0;
  for (const auto& hole : bracket::kBaseHoles) holes += hole.radius * hole.radius;
  for (const auto& hole : bracket::kUprightHoles) holes += hole.radius * hole.radius;
  const double plates = 90 * 60 * 8 + 8 * 60 * 52;
  const double boss = std::numbers::pi * 10 * 10 * 12;
  const double volume = (plates + boss - std::numbers::pi * holes * 8) * 1e-9;
  EXPECT_NEAR(part.mass.volume, volume, 2e-3 * volume);  // facets of 0.1 mm on the boss and the holes
  EXPECT_NEAR(volume_of(part.pieces_P), (plates + boss) * 1e-9, 1e-6 * volume);
  EXPECT_TRUE(part.symmetry.trivial());
}

TEST(OwnParts, TeeIsTheOneOfItsDrawing) {
  const Part part = own_part("tee");
  const double volume = (64 * 20 + 20 * 40) * 16e-9;
  EXPECT_NEAR(part.mass.volume, volume, 1e-6 * volume);
  EXPECT_NEAR(volume_of(part.pieces_P), volume, 1e-9 * volume);
  const double y = (64 * 20 * 20 - 20 * 40 * 10) / (64.0 * 20 + 20 * 40) / 1000;  // bar at +20, stem at -10 mm
  EXPECT_LT((part.mass.center_P - Eigen::Vector3d(0, y, 0)).norm(), 1e-8);
  ASSERT_EQ(part.symmetry.finite.size(), 2u);
  EXPECT_FALSE(part.symmetry.axis);
}

TEST(OwnParts, BoltIsTheOneOfItsDrawing) {
  const Part part = own_part("bolt_m24x80");
  const double head = std::sqrt(3) / 2 * 36 * 36 * 15;               // of a hexagon by its width across flats
  const double cone = std::numbers::pi / 3 * 2 * (144 + 120 + 100);  // the chamfered end: 12 to 10 over 2 mm
  const double shank = std::numbers::pi * 144 * 78;
  const double volume = (head + shank + cone) * 1e-9;
  EXPECT_NEAR(part.mass.volume, volume, 1e-2 * volume);  // facets of 0.1 mm on a radius of 12
  EXPECT_LT(part.mass.volume, volume);
  EXPECT_NEAR(volume_of(part.pieces_P), (head + std::numbers::pi * 144 * 80) * 1e-9, 1e-6 * volume);
  EXPECT_LT((bounding_box(part.mesh_P).sizes() - Eigen::Vector3d(0.036, 0.036 * 2 / std::sqrt(3), 0.095)).norm(), 1e-7);
  EXPECT_EQ(part.symmetry.finite.size(), 6u);
}

TEST(OwnParts, GearHasInvoluteFlanks) {
  const Part part = own_part("gear_m3_z24");
  EXPECT_EQ(part.symmetry.finite.size(), 48u);
  const auto inv = [](double x) { return std::tan(x) - x; };
  const double alpha = 20 * std::numbers::pi / 180, base = 36 * std::cos(alpha);
  // Tooth thickness at the pitch circle is half the pitch; measured along rays across the face, tooth by tooth.
  const MeshQuery query(part.mesh_P);
  for (const double r : {34.0, 35.0, 36.0, 37.5, 38.9}) {
    const double half = std::numbers::pi / 48 + inv(alpha) - inv(std::acos(base / r));
    for (int tooth = 0; tooth < 24; ++tooth) {
      const auto inside = [&](double offset) {  // mm along the circle from the flank, into the gap
        const double angle = tooth * std::numbers::pi / 12 + half + offset / r;
        return query.ray({r * 1e-3 * std::cos(angle), r * 1e-3 * std::sin(angle), 0.05}, {0, 0, -1}, 0.2).has_value();
      };
      EXPECT_TRUE(inside(-0.12)) << r << " mm, tooth " << tooth;
      EXPECT_FALSE(inside(0.12)) << r << " mm, tooth " << tooth;
    }
  }
  const Eigen::Vector3d size = bounding_box(part.mesh_P).sizes();
  EXPECT_NEAR(size.x(), 0.078, 3.1e-5);  // a tip land of +-1.58 degrees as one facet lies 0.015 mm within its circle
  EXPECT_NEAR(size.z(), 0.020, 1e-9);
  // A piece a tooth: over the whole width there is something at the pitch circle on a tooth, and nothing in a gap.
  ASSERT_EQ(part.pieces_P.size(), 24u);
  TriangleMesh pieces;
  for (const TriangleMesh& piece : part.pieces_P) append(pieces, piece);
  const MeshQuery collides(pieces);
  for (int half_pitch = 0; half_pitch < 48; ++half_pitch) {
    const double angle = half_pitch * std::numbers::pi / 24;
    const auto hit = collides.ray({0.036 * std::cos(angle), 0.036 * std::sin(angle), 0.05}, {0, 0, -1}, 0.2);
    ASSERT_EQ(hit.has_value(), half_pitch % 2 == 0) << half_pitch;
    EXPECT_NEAR(hit ? hit->point.z() : 0.01, 0.01, 1e-9);
  }
  EXPECT_NEAR(bounding_box(pieces).sizes().x(), size.x(), 3.1e-5);
}

TEST(OwnParts, PlateIsTheOneOfItsDrawing) {
  const Part part = own_part("plate_100x60");
  const double slot = 10 * 26 + std::numbers::pi * 25;
  const double volume = (100 * 60 - 2 * std::numbers::pi * 49 - slot) * 4e-9;
  EXPECT_NEAR(part.mass.volume, volume, 2e-3 * volume);
  EXPECT_NEAR(volume_of(part.pieces_P), volume, 1e-6 * volume);  // holes and slot are squares of the same area
  EXPECT_LT(part.mass.center_P.norm(), 1e-7);
  EXPECT_EQ(part.symmetry.finite.size(), 4u);
}

TEST(OwnParts, ShaftIsTheOneOfItsDrawing) {
  const Part part = own_part("shaft_25_35x120");
  const double volume = std::numbers::pi * 60e-9 * (17.5 * 17.5 + 12.5 * 12.5);
  EXPECT_NEAR(part.mass.volume, volume, 1.5e-2 * volume);  // facets and chamfers
  EXPECT_NEAR(volume_of(part.pieces_P), volume, 1e-6 * volume);
  EXPECT_NEAR(part.mass.center_P.z(), (17.5 * 17.5 * -0.03 + 12.5 * 12.5 * 0.03) / (17.5 * 17.5 + 12.5 * 12.5), 5e-4);
  EXPECT_TRUE(part.symmetry.axis.has_value());
  EXPECT_EQ(part.symmetry.finite.size(), 1u);
}

TEST(OwnParts, StatedSymmetriesCarryTheMeshIntoItself) {
  for (const std::string& name : kOwnParts) {
    const Part part = own_part(name);
    for (const Pose& X_PP : sampled_group(part.symmetry, 12)) {
      // Facets of round surfaces do not map onto each other: two chord tolerances. Inner balls do not matter.
      EXPECT_LT(worst_distance(transformed(X_PP, part.envelope_P), part.envelope_P), 2e-4) << name;
    }
  }
}

TEST(OwnParts, NoOtherHalfOrQuarterTurnDoes) {
  for (const std::string name : {"bracket_l", "tee", "plate_100x60"}) {
    const Part part = own_part(name);
    std::size_t members = 0;
    std::set<std::string> seen;
    for (int x = 0; x < 4; ++x) {
      for (int y = 0; y < 4; ++y) {
        for (int z = 0; z < 4; ++z) {  // all 24 turns of a cube about the box centre, some more than once
          const double quarter = std::numbers::pi / 2;
          const Pose R = pose_from_xyz_rpy({0, 0, 0}, {x * quarter, y * quarter, z * quarter});
          const Eigen::Matrix3d rounded = R.linear().array().round();
          std::string key;
          for (Eigen::Index k = 0; k < 9; ++k) key += std::to_string(static_cast<int>(rounded(k))) + " ";
          if (!seen.insert(key).second) continue;
          const Pose to_center(Eigen::Translation3d(part.box_center_P));
          const Pose X_PP = to_center * pose_from(rounded, {0, 0, 0}) * to_center.inverse();
          members += worst_distance(transformed(X_PP, part.mesh_P), part.mesh_P) < 2e-4;
        }
      }
    }
    EXPECT_EQ(seen.size(), 24u);
    EXPECT_EQ(members, part.symmetry.finite.size()) << name;
  }
}

#ifdef BINPICK_WITH_STEP
TEST(OwnParts, StepAndStlAreTheSameShape) {
  for (const std::string& name : kOwnParts) {
    SCOPED_TRACE(name);
    const TriangleMesh stl = read_mesh(folder_of(name) + "/" + name + ".stl");
    const TriangleMesh step = read_mesh(folder_of(name) + "/" + name + ".step", {"", 1e-4});
    const double volume = mass_properties(step, 1).volume;
    EXPECT_NEAR(mass_properties(stl, 1).volume, volume, 1e-3 * volume);
    const Eigen::AlignedBox3d a = bounding_box(stl), b = bounding_box(step);
    EXPECT_LT((a.min() - b.min()).cwiseAbs().maxCoeff(), 1e-4);  // the chord tolerance
    EXPECT_LT((a.max() - b.max()).cwiseAbs().maxCoeff(), 1e-4);
    EXPECT_LT(worst_distance(stl, step), 2e-4);
  }
}
#endif

TEST(OwnParts, TrackedPiecesAreThoseOfTheProgram) {
  const std::vector<std::vector<TriangleMesh>> made = {bearing_pieces(), bracket_pieces(), tee_pieces(),  bolt_pieces(),
                                                       gear_pieces(),    plate_pieces(),   shaft_pieces()};
  for (std::size_t i = 0; i < kOwnParts.size(); ++i) {
    const Part part = own_part(kOwnParts[i]);
    ASSERT_EQ(part.pieces_P.size(), made[i].size());
    for (std::size_t k = 0; k < made[i].size(); ++k) EXPECT_LT(worst_distance(part.pieces_P[k], made[i][k]), 1e-7);
  }
}

TEST(OwnParts, FilesAreSmall) {
  for (const std::string& name : kOwnParts) {
    for (const auto& entry : std::filesystem::directory_iterator(folder_of(name))) {
      EXPECT_LT(entry.file_size(), 1u << 20) << entry.path();
    }
  }
}

class PartFile : public testing::Test {
 protected:
  PartFile() { folder_.put("block.stl", samples::binary_stl()); }
  Part load(const std::string& yaml) { return load_part(read_part_spec(folder_.put("part.yaml", yaml))); }
  std::string open_stl() {
    std::string bytes = samples::binary_stl();
    bytes.resize(bytes.size() - 50);
    return samples::with_u32(bytes, 80, 11);
  }
  TempFolder folder_;
};

TEST_F(PartFile, DefaultsAreEnough) {
  const Part part = load("mesh: block.stl\n");
  EXPECT_EQ(part.name, "block");
  EXPECT_NEAR(part.mass.mass, 4.8e-5 * 2700, 1e-6);
  EXPECT_EQ(part.friction, 0.4);
  EXPECT_EQ(part.symmetry.finite.size(), 4u);  // found: the half turns of a block of three different edges
  EXPECT_TRUE(part.pieces_P.empty());
  EXPECT_LT((part.box_center_P - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 1e-8);
}

TEST_F(PartFile, AnotherScaleIsTheSameShape) {
  const Part whole = load("mesh: block.stl\n"), half = load("mesh: block.stl\nscale: 0.5\n");
  EXPECT_NEAR(half.diameter, whole.diameter / 2, 1e-9);
  EXPECT_NEAR(half.mass.mass, whole.mass.mass / 8, 1e-9);
  EXPECT_LT((half.box_center_P - whole.box_center_P / 2).norm(), 1e-9) << "about the file's origin";
  PartSpec spec = read_part_spec(folder_.put("whole.yaml", "mesh: block.stl\n"));
  EXPECT_EQ(write_yaml([&](ConfigVisitor& v) { spec.visit(v); }).find("scale"), std::string::npos)
      << "scenes without it keep their hash";
}

#ifdef BINPICK_WITH_STEP
TEST_F(PartFile, HoldsTheChordAtItsOwnScale) {
  folder_.put("tee.step", samples::step());
  const Part part = load("mesh: tee.step\nscale: 2\ndensity: 7860\n");
  EXPECT_NEAR(part.mass.mass, 8 * 33280e-9 * 7860, 1e-8);
}

TEST_F(PartFile, MayBeAStepFile) {
  folder_.put("tee.step", samples::step());
  const Part part = load("mesh: tee.step\nchord_tolerance: 0.2 mm\ndensity: 7860\n");
  EXPECT_EQ(part.name, "tee");
  EXPECT_NEAR(part.mass.mass, 33280e-9 * 7860, 1e-9);
}
#endif

TEST_F(PartFile, StatedMassDecidesTheDensity) {
  const Part part = load("mesh: block.stl\nmass: 480 g\n");
  EXPECT_EQ(part.mass.mass, 0.48);
  EXPECT_NEAR(part.density, 10000, 0.1);
  EXPECT_NEAR(part.mass.inertia_P(2, 2), 0.48 * (0.06 * 0.06 + 0.04 * 0.04) / 12, 1e-9);
}

TEST_F(PartFile, OpenMeshNeedsAMassAndGetsItsHull) {
  folder_.put("open.stl", open_stl());
  try {
    load("mesh: open.stl\n");
    FAIL() << "accepted";
  } catch (const AssetError& error) {
    EXPECT_THAT(error.what(), HasSubstr("open.stl: the mesh is not closed"));
    EXPECT_THAT(error.what(), HasSubstr("mass:"));
  }
  const Part part = load("mesh: open.stl\nmass: 0.1\n");
  EXPECT_EQ(part.mesh_P.triangles.size(), 11u);
  EXPECT_NEAR(part.mass.volume, 4.8e-5, 1e-10);  // a block is its own hull
  EXPECT_TRUE(is_closed(part.envelope_P));
  EXPECT_EQ(part.mass.mass, 0.1);
}

TEST_F(PartFile, ContentHashFollowsEveryValue) {
  const std::string base = "name: a\nmesh: block.stl\n";
  folder_.put("same.stl", samples::binary_stl());
  folder_.put("other.stl", samples::binary_stl(1001));
  std::set<std::uint64_t> hashes = {load(base).content_hash};
  EXPECT_EQ(load("name: a\nmesh: same.stl\n").content_hash, *hashes.begin()) << "the path is no value";
  for (const std::string more :
       {"density: 2701\n", "mass: 0.5\n", "friction: 0.41\n", "restitution: 0.2\n", "unit: cm\n", "scale: 0.5\n",
        "symmetry: {type: cyclic, order: 2}\n", "symmetry: {type: cyclic, order: 3}\n",
        "symmetry: {type: revolution}\n", "symmetry: {type: revolution, flip: true}\n",
        "symmetry: {type: revolution, axis: [1, 0, 0]}\n", "envelope: other.stl\n"}) {
    EXPECT_TRUE(hashes.insert(load(base + more).content_hash).second) << more;
  }
  EXPECT_TRUE(hashes.insert(load("name: b\nmesh: block.stl\n").content_hash).second);
}

TEST_F(PartFile, SpecSurvivesWritingAndReading) {
  PartSpec spec = read_part_spec(folder_of("bearing_6914") + "/part.yaml");
  const std::string text = write_yaml([&](ConfigVisitor& v) { spec.visit(v); });
  PartSpec again;
  read_yaml_text(text, "part.yaml", "/", [&](ConfigVisitor& v) { again.visit(v); });
  EXPECT_EQ(load_part(spec).content_hash, load_part(again).content_hash);
}

TEST_F(PartFile, BadPartsAreRefusedInOneLine) {
  folder_.put("open.stl", open_stl());
  const std::string two = "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\n";
  folder_.put("open.obj", two + "f 1 3 2\nf 1 2 4\nf 2 3 4\n");
  folder_.put("dent.obj", two + "v 5 5 5\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n");
  folder_.put("flat.obj", "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 40 40 0\nf 1 2 3\nf 3 2 4\nf 1 3 2\nf 3 4 2\n");
  folder_.put("sheet.obj", "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 40 40 0\nf 1 2 3\nf 3 2 4\n");
  const std::vector<std::array<std::string, 2>> cases = {
      {"", "empty"},
      {"mesh: missing.stl\n", "missing.stl: cannot open"},
      {"mash: block.stl\n", "unknown key"},
      {"mesh: block.stl\nmesh: block.stl\n", "mesh"},
      {"mesh: [block.stl]\n", "mesh"},
      {"mesh: block.stl\nunit: furlong\n", "unit"},
      {"mesh: block.stl\nunit: m\n", "`unit: mm`"},
      {"mesh: block.stl\nscale: 0\n", "scale"},
      {"mesh: block.stl\nscale: -1\n", "scale"},
      {"mesh: block.stl\nscale: 50\n", "lies outside 1 mm .. 2000 mm"},
      {"mesh: block.stl\ndensity: -1\n", "density"},
      {"mesh: block.stl\ndensity: .nan\n", "density"},
      {"mesh: block.stl\ndensity: 2,7\n", "density"},
      {"mesh: block.stl\ndensity: 5 mm\n", "density"},
      {"mesh: block.stl\nmass: -0.1\n", "mass"},
      {"mesh: block.stl\nmass: 1e999\n", "mass"},
      {"mesh: block.stl\nfriction: 5\n", "friction"},
      {"mesh: block.stl\nfriction: -0.1\n", "friction"},
      {"mesh: block.stl\nrestitution: 1.5\n", "restitution"},
      {"mesh: block.stl\nchord_tolerance: 0\n", "chord_tolerance"},
      {"mesh: block.stl\nsymmetry: {type: spherical}\n", "symmetry"},
      {"mesh: block.stl\nsymmetry: {type: cyclic, order: 0}\n", "order"},
      {"mesh: block.stl\nsymmetry: {type: cyclic, axis: [0, 0, 0]}\n", "axis"},
      {"mesh: block.stl\npieces: missing.obj\n", "missing.obj: cannot open"},
      {"mesh: block.stl\npieces: block.stl\n", "objects of an .obj"},
      {"mesh: block.stl\npieces: open.obj\n", "object 1 is not closed"},
      {"mesh: block.stl\npieces: dent.obj\n", "object 1 is not convex"},
      {"mesh: block.stl\npieces: flat.obj\n", "object 1 encloses no volume"},
      {"mesh: flat.obj\n", "flat.obj: the mesh is closed but encloses no volume"},
      {"mesh: sheet.obj\nmass: 0.1\n", "sheet.obj: the mesh is flat"},
      {"mesh: block.stl\nenvelope: open.stl\n", "not closed"},
      {"mesh: \"\"\n", "mesh: is empty"},
      {"name: nothing\n", "mesh: a part needs a CAD file"},
      {"mesh: block.stl\n\tname: tab\n", "part.yaml"},
      {"{mesh: block.stl", "part.yaml"},
      {std::string("mesh: block.stl\0\n", 17), "part.yaml"},
  };
  for (const auto& [yaml, says] : cases) {
    SCOPED_TRACE(yaml);
    try {
      load(yaml);
      ADD_FAILURE() << "accepted";
    } catch (const std::exception& error) {
      EXPECT_TRUE(dynamic_cast<const SpecError*>(&error) || dynamic_cast<const AssetError*>(&error)) << error.what();
      const std::string message = error.what();
      EXPECT_THAT(message, HasSubstr(says));
      EXPECT_THAT(message, HasSubstr(folder_.at(""))) << "the file is not named";
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

}  // namespace
}  // namespace binpick

// What URDFs of the wild do (physical_models C2), and what is said when they do too much.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.hpp"
#include "robot_fixture.hpp"

namespace binpick {
namespace {

using namespace testing_robot;
namespace fs = std::filesystem;

std::string text_of(const std::string& file) {
  std::ostringstream buffer;
  buffer << std::ifstream(file).rdbuf();
  return buffer.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const std::string kIrb = "arms/irb1200_description/urdf/irb1200_5_90.urdf";

/// A folder of its own for each test.
class Urdf : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  std::string write(const std::string& text, const std::string& name = "arm.urdf") const {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
    return (folder / name).string();
  }
  std::string error_of(const ArmSource& source) const {
    try {
      Arm::load(source);
    } catch (const AssetError& error) {
      return error.what();
    }
    return "";
  }
  std::string error_of(const std::string& text) const { return error_of(ArmSource{write(text), {}, ""}); }
  static void expect_says(const std::string& error, const std::string& expected) {
    EXPECT_NE(error.find(expected), std::string::npos) << "expected: " << expected << "\ngot: " << error;
  }
  fs::path folder;
};

Eigen::AlignedBox3d bounds(const std::vector<Primitive>& shapes) {
  Eigen::AlignedBox3d box;
  for (const Primitive& shape : shapes)
    for (const Eigen::Vector3d& p : mesh_of(shape).vertices) box.extend(p);
  return box;
}

void expect_box(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  EXPECT_LT((box.min() - low).cwiseAbs().maxCoeff(), 1e-6) << box.min().transpose();
  EXPECT_LT((box.max() - high).cwiseAbs().maxCoeff(), 1e-6) << box.max().transpose();
}

TEST_F(Urdf, MeshesOfAPackageCountAsBoxesInMetres) {
  const Arm arm = Arm::load(asset(kIrb));
  EXPECT_EQ(arm.mesh_files().size(), 2u);
  // An STL in millimetres with a scale, and a Collada file with a unit of its own and Z up.
  expect_box(bounds(arm.link_shapes()[2]), {-0.075, -0.1, -0.075}, {0.075, 0.1, 0.51});
  expect_box(bounds(arm.link_shapes()[4]), {0.075, -0.05, -0.05}, {0.5, 0.05, 0.05});
  // The upper arm is slender between its joints, and so are its boxes.
  double slenderest = 1;
  for (const Primitive& box : arm.link_shapes()[2]) slenderest = std::min(slenderest, box.size.y());
  EXPECT_NEAR(slenderest, 0.11, 1e-6);
}

TEST_F(Urdf, WhatHangsOnAFixedJointBelongsToItsLink) {
  const Arm arm = Arm::load(asset(kIrb));
  expect_box(bounds(arm.link_shapes()[3]), {-0.12, -0.06, -0.035}, {0.105, 0.06, 0.095});  // with the cable box
}

TEST_F(Urdf, ALinkWithoutCollisionGeometryCountsAsDrawn) {
  const Arm arm = Arm::load(asset("arms/lrmate_200id.urdf"));
  ASSERT_EQ(arm.link_shapes()[2].size(), 2u);
  EXPECT_EQ(arm.link_shapes()[2].front().size, Eigen::Vector3d(0.11, 0.11, 0.33));
}

TEST_F(Urdf, PackagesAreLookedForAboveTheFileAndInTheSearchList) {
  const std::string urdf = write(text_of(asset(kIrb)));  // away from its package
  expect_says(error_of(ArmSource{urdf, {}, ""}), "no folder of that package lies above the URDF or in the search list");
  const std::string arms = asset("arms");
  EXPECT_EQ(Arm::load(ArmSource{urdf, {folder.string(), arms}, ""}).mesh_files().size(), 2u);
  EXPECT_EQ(Arm::load(ArmSource{urdf, {arms + "/irb1200_description/"}, ""}).mesh_files().size(), 2u);
  // The first folder that has the file wins; a package without it is passed over.
  write("no mesh", "irb1200_description/README");
  EXPECT_EQ(Arm::load(ArmSource{urdf, {folder.string(), arms}, ""}).mesh_files().size(), 2u);
  const std::string missing = error_of(ArmSource{urdf, {folder.string()}, ""});
  expect_says(missing,
              "link 'link_2' names a mesh file 'package://irb1200_description/meshes/link_2.stl' that does not");
  expect_says(missing, "looked for " + (folder / "irb1200_description/meshes/link_2.stl").string());
}

TEST_F(Urdf, NoMeshOutsideItsFolders) {
  const std::string good = text_of(asset(kIrb));
  const std::string bad = replaced(good, "irb1200_description/meshes/link_4.dae", "irb1200_description/../../x.dae");
  expect_says(error_of(ArmSource{write(bad), {asset("arms")}, ""}), "leaves the folder of the URDF or of its package");
}

TEST_F(Urdf, DamagedMeshesAreNamed) {
  const auto with_dae = [&](const std::string& bytes) {
    write(bytes, "irb1200_description/meshes/link_4.dae");
    write(text_of(asset("arms/irb1200_description/meshes/link_2.stl")), "irb1200_description/meshes/link_2.stl");
    return error_of(ArmSource{write(text_of(asset(kIrb))), {folder.string()}, ""});
  };
  const std::string good = text_of(asset("arms/irb1200_description/meshes/link_4.dae"));
  EXPECT_EQ(with_dae(good), "");
  expect_says(with_dae(""), "link_4.dae: is empty");
  expect_says(with_dae("solid"), "link_4.dae: is no Collada file");
  expect_says(with_dae(good.substr(0, good.size() / 2)), "link_4.dae: ");
  expect_says(with_dae(replaced(good, "<p>0 2 1", "<p>0 2 999")), "link_4.dae: ");
}

TEST_F(Urdf, AMeshInMillimetresWithoutAScaleIsNamed) {
  const std::string good = text_of(asset(kIrb));
  const std::string bad =
      replaced(replaced(good, " scale=\"0.001 0.001 0.001\"", ""), " scale=\"0.001 0.001 0.001\"", "");
  expect_says(error_of(ArmSource{write(bad), {asset("arms")}, ""}), "URDF meshes are metres");
}

TEST_F(Urdf, TheFlangeIsFoundOrAsked) {
  const std::string tx2 = text_of(asset("arms/tx2_60l.urdf"));
  const auto with_frame = [&](const std::string& name, const std::string& parent) {
    return replaced(tx2, "</robot>",
                    "<link name=\"" + name + "\"/><joint name=\"to_" + name + "\" type=\"fixed\"><parent link=\"" +
                        parent + "\"/><child link=\"" + name + "\"/></joint></robot>");
  };
  EXPECT_EQ(Arm::load(write(with_frame("base", "base_link"))).flange_name(), "link_6");
  EXPECT_EQ(Arm::load(write(with_frame("tool0", "link_6"))).flange_name(), "tool0");
  std::string two = with_frame("left", "link_6");
  two =
      replaced(two, "</robot>",
               "<link name=\"right\"/><joint name=\"r\" type=\"fixed\"><parent link=\"link_6\"/><child link=\"right\"/>"
               "</joint></robot>");
  expect_says(error_of(two), "has several end links ('left', 'right')");
  EXPECT_EQ(Arm::load(ArmSource{write(two), {}, "right"}).flange_name(), "right");
  expect_says(error_of(ArmSource{write(two), {}, "nose"}),
              "has no link 'nose' (the cell's arm_tip); its links: base_link");
}

TEST_F(Urdf, FaultsAreNamed) {
  const std::string ur = text_of(asset("arms/ur5e.urdf"));
  expect_says(error_of(replaced(ur, " effort=\"150\"", "")), "no effort");
  expect_says(error_of(replaced(ur, "velocity=\"3.14159", "velocity=\"0\" was=\"")), "has no positive speed limit");
  expect_says(error_of(replaced(ur, "<robot", "<robot xmlns:xacro=\"x\"><xacro:include/></robot><robot")),
              "is a xacro");
  expect_says(error_of(replaced(ur, "type=\"continuous\"", "type=\"floating\"")), "'wrist_3_joint' is not revolute");
  expect_says(error_of(replaced(ur, "\"wrist_3_joint\" type=\"continuous\"", "\"wrist\n3\" type=\"floating\"")),
              "'wrist?3' is not revolute");
}

TEST_F(Urdf, LinksThatAreNoTreeAreRefused) {
  const auto joint = [](const std::string& name, const std::string& parent, const std::string& child) {
    return "<joint name=\"" + name + "\" type=\"fixed\"><parent link=\"" + parent + "\"/><child link=\"" + child +
           "\"/></joint>";
  };
  const std::string links =
      "<robot name=\"a\"><link name=\"base\"/><link name=\"side\"/><link name=\"tool0\"/><link name=\"end\"/>";
  expect_says(error_of(links + joint("i", "base", "side") + joint("j", "tool0", "end") + joint("k", "end", "tool0") +
                       "</robot>"),
              "has joints that form a loop at link 'end'");
  expect_says(error_of(links + joint("i", "base", "side") + joint("j", "base", "end") + joint("k", "side", "tool0") +
                       joint("l", "tool0", "side") + "</robot>"),
              "has two joints that carry link 'side'");
}

TEST_F(Urdf, NestedTooDeepOrTooWideForTheParserIsRefused) {
  std::string deep = "<robot name=\"deep\">", wide = "<robot name=\"wide\"";
  for (int i = 0; i < 300000; ++i) deep += "<a>";  // the parser calls itself: a stack overflow
  for (int i = 0; i < 200000; ++i) wide += " a" + std::to_string(i) + "=\"1\"";  // minutes
  expect_says(error_of(deep), "has more than 20000 tags");
  expect_says(error_of(wide + "/>"), "has an element of more than 1000 attributes");
}

}  // namespace
}  // namespace binpick

// A bin from CAD is held against the inner size it states; what lies beyond plain walls is boxed in for planners.
#include "core/bin_mesh.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/mesh_io.hpp"
#include "core/sample_surface.hpp"
#include "tests/core/open_box.hpp"
#include "tests/core/temp_folder.hpp"

namespace binpick {
namespace {

BinSpec small_bin(const std::string& mesh) {
  BinSpec bin;
  bin.inner_size = {0.3, 0.2, 0.1};
  bin.wall = 0.003;
  bin.mesh = mesh;
  return bin;
}

std::string stored(const TempFolder& folder, const TriangleMesh& mesh) {
  write_stl(folder.at("bin.stl"), mesh);
  return folder.at("bin.stl");
}

std::string refusal(BinSpec bin) {
  try {
    bin.load();
  } catch (const AssetError& error) {
    return error.what();
  }
  return "";
}

TEST(BinMesh, APlainBoxHasNothingBeyondItsWalls) {
  TempFolder folder;
  BinSpec bin = small_bin(stored(folder, open_box({0.3, 0.2, 0.1}, 0.003)));
  bin.load();
  EXPECT_TRUE(bin.shaped());
  EXPECT_TRUE(bin.solid->beyond_plain.empty());
  EXPECT_FALSE(bin.plain().shaped());
}

TEST(BinMesh, FloorOrWallElsewhereIsSaidWithTheSide) {
  TempFolder folder;
  BinSpec bin = small_bin(stored(folder, open_box({0.3, 0.2, 0.1}, 0.003)));
  bin.inner_size.x() = 0.35;
  EXPECT_NE(refusal(bin).find("no wall at +x"), std::string::npos) << refusal(bin);
  bin = small_bin(bin.mesh);
  bin.draft = 0.3;  // 31 mm at the rim
  EXPECT_NE(refusal(bin).find("no wall at"), std::string::npos) << refusal(bin);
  TriangleMesh raised = open_box({0.3, 0.2, 0.1}, 0.003);
  for (Eigen::Vector3d& v : raised.vertices) v.z() += 0.05;
  bin = small_bin(stored(folder, raised));
  EXPECT_NE(refusal(bin).find("no floor"), std::string::npos) << refusal(bin);
  bin.mesh_unit = "inch";
  EXPECT_NE(refusal(bin), "");
}

TEST(BinMesh, AnOpenMeshIsRefused) {
  TempFolder folder;
  TriangleMesh mesh = open_box({0.3, 0.2, 0.1}, 0.003);
  mesh.triangles.pop_back();
  EXPECT_NE(refusal(small_bin(stored(folder, mesh))).find("closed"), std::string::npos);
}

TEST(BinMesh, DividersBelongToTheMesh) {
  BinSpec bin = small_bin("bin.stl");
  bin.dividers_x = {0.0};
  EXPECT_THROW(bin.validate(), SpecError);
}

bool near_any(const std::vector<Primitive>& boxes, const Eigen::Vector3d& p_B, double within) {
  for (const Primitive& box : boxes)
    if (((box.X_OS.inverse() * p_B).cwiseAbs() - box.size / 2).maxCoeff() <= within) return true;
  return false;
}

TEST(BinMesh, PlainWallsAndBoxesHoldTheWholeTote) {
  BinSpec bin;
  bin.inner_size = {0.4, 0.3, 0.2};
  bin.draft = 0.0523598776;  // 3 degrees
  bin.wall = 0.004;
  bin.mesh = std::string(BINPICK_SOURCE_DIR) + "/assets/bins/tote_400x300.stl";
  bin.load();
  std::vector<Primitive> boxes = bin_boxes(bin, bin.wall);
  boxes.insert(boxes.end(), bin.solid->beyond_plain.begin(), bin.solid->beyond_plain.end());
  EXPECT_LE(bin.solid->beyond_plain.size(), 60u);
  int outside = 0;
  const PointCloud samples = sample_surface(bin.solid->mesh_B, 0.002, Seed{5});
  for (const Eigen::Vector3d& p : samples.points) outside += !near_any(boxes, p, 0.002);
  EXPECT_EQ(outside, 0) << "of " << samples.points.size();
  // And they leave the middle of the bin free.
  for (double x = -0.19; x < 0.19; x += 0.01)
    for (double y = -0.10; y < 0.10; y += 0.01)
      EXPECT_FALSE(std::abs(x) < 0.17 && near_any(boxes, {x, y, 0.05}, 0.005)) << x << " " << y;
}

}  // namespace
}  // namespace binpick

#include "robot/cell.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.hpp"
#include "robot/collision_check.hpp"
#include "robot/reach.hpp"
#include "robot_fixture.hpp"

namespace binpick {
namespace {

using namespace testing_robot;

class EveryCell : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Cells, EveryCell, kCellOfEveryArm);
INSTANTIATE_TEST_SUITE_P(OneCup, EveryCell, testing::Values("mz07_one_cup"));

TEST_P(EveryCell, IsValidAndSurvivesWritingAndReading) {
  const Cell cell = cell_named(GetParam());
  EXPECT_NO_THROW(cell.validate());
  Cell copy;
  const auto write = [](Cell& c) { return write_yaml([&](ConfigVisitor& v) { c.visit(v); }); };
  Cell original = cell;
  const std::string text = write(original);
  read_yaml_text(text, "copy", "", [&](ConfigVisitor& v) { copy.visit(v); });
  copy.finish();
  EXPECT_EQ(write(copy), text);
  EXPECT_EQ(copy.q_look, cell.q_look);
}

TEST_P(EveryCell, CameraLooksDownFrom600MillimetresAboveTheBinFloor) {
  const Cell cell = cell_named(GetParam());
  const Pose X_BC = cell.X_WB.inverse() * cell.camera_pose(cell.q_look);
  EXPECT_LT((X_BC.translation() - Eigen::Vector3d(0, 0, 0.6)).norm(), 1e-9);
  EXPECT_LT((X_BC.linear().col(2) + Eigen::Vector3d::UnitZ()).norm(), 1e-9);
}

/// Points on the surface of a primitive, coarse.
std::vector<Eigen::Vector3d> surface_points(const Primitive& shape) { return mesh_of(shape, 24).vertices; }

TEST_P(EveryCell, ToolHidesNothingOfTheBin) {
  const Cell cell = cell_named(GetParam());
  const Pose X_WC = cell.camera_pose(cell.q_look), X_CW = X_WC.inverse();
  const PinholeCamera camera;
  // The bin's inner space as seen: floor and rim corners bound it.
  Eigen::AlignedBox2d bin;
  const Eigen::Vector3d half = cell.bin.inner_size / 2;
  for (const double x : {-half.x(), half.x()})
    for (const double y : {-half.y(), half.y()})
      for (const double z : {0.0, cell.bin.inner_size.z()})
        bin.extend(camera.project(X_CW * (cell.X_WB * Eigen::Vector3d(x, y, z))));
  EXPECT_GT(bin.min().minCoeff(), 0);
  EXPECT_LT(bin.max().x(), camera.width);
  EXPECT_LT(bin.max().y(), camera.height);
  const Pose X_CG = X_CW * cell.tip_pose(cell.q_look);
  for (const Primitive& body : cell.gripper->body_G()) {
    Eigen::AlignedBox2d seen;
    for (const Eigen::Vector3d& p_G : surface_points(body)) {
      const Eigen::Vector3d p_C = X_CG * p_G;
      if (p_C.z() > 0.02) seen.extend(camera.project(p_C));
    }
    EXPECT_TRUE(seen.isEmpty() || seen.intersection(bin).isEmpty());
  }
}

TEST_P(EveryCell, TipReachesTheWholeBinAndTheTray) {
  const Cell cell = cell_named(GetParam());
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  // Tip to wall: in the bin the stem's radius, in the tray half of the smallest part that is put down there.
  constexpr double kBinWall = 0.012, kTrayWall = 0.035;
  for (int i = 0; i <= 6; ++i) {
    for (int j = 0; j <= 6; ++j) {
      const auto at = [&](const Eigen::Vector3d& size, double wall, double z) {
        return Eigen::Vector3d((size.x() / 2 - wall) * (i / 3.0 - 1), (size.y() / 2 - wall) * (j / 3.0 - 1), z);
      };
      for (const double z : {0.002, 0.1, 0.2, 0.24})
        EXPECT_TRUE(reaches(cell, cell.X_WB * at(cell.bin.inner_size, kBinWall, z), down))
            << "bin " << i << ' ' << j << ' ' << z;
      for (const double z : {0.002, 0.08})
        EXPECT_TRUE(reaches(cell, cell.tray.X_WT * at(cell.tray.inner_size, kTrayWall, z), down))
            << "tray " << i << ' ' << j;
    }
  }
}

TEST_P(EveryCell, TipReachesTheBinTilted30DegreesTowardsItsMiddle) {
  const Cell cell = cell_named(GetParam());
  const double tilt = std::numbers::pi / 6;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const Eigen::Vector3d corner(sx * (cell.bin.inner_size.x() / 2 - 0.012),
                                   sy * (cell.bin.inner_size.y() / 2 - 0.012), 0.01);
      // The tool leans with its flange towards the middle of the bin, so it points into the corner.
      const Eigen::Vector3d outward = Eigen::Vector3d(sx, sy, 0).normalized();
      const Eigen::Vector3d axis = std::sin(tilt) * outward - std::cos(tilt) * Eigen::Vector3d::UnitZ();
      EXPECT_TRUE(reaches(cell, cell.X_WB * corner, axis)) << sx << ' ' << sy;
    }
  }
}

std::string error_of(const std::string& extra) {
  const std::string text =
      "arm: arms/mz07.urdf\nbin: {inner_size: [0.3, 0.4, 0.2]}\ntray: {pose: {xyz: [0, -0.49, 0.005]}, "
      "inner_size: [0.56, 0.36, 0.04]}\ngripper: {type: suction}\n";
  Cell cell;
  try {
    read_yaml_text(text + extra, "cell.yaml", asset(""), [&](ConfigVisitor& v) { cell.visit(v); });
    cell.finish();
    cell.validate();
  } catch (const SpecError& error) {
    return error.what();
  }
  return "";
}

TEST(BadCell, EachSaysWhatIsWrong) {
  ASSERT_EQ(error_of(""), "");
  const std::pair<std::string, std::string> cases[] = {
      {"bin_pose: {xyz: [0.9, 0, 0.005]}\n", "cell.bin: unreachable"},
      {"home: [0, 100 deg, 46 deg, 0, 0, 0]\n", "cell.home: the arm would be in collision with the table"},
      {"home: [0, 140 deg, 0, 0, 0, 0]\n", "cell.home: joint 2 at 140.0 degrees lies outside -80.0 .. 135.0"},
      {"home: [0, 0, 0]\n", "cell.home: must list six joint angles"},
      {"look: {camera: {xyz: [2, 0, 1]}}\n", "cell.look.camera: the arm cannot reach"},
      {"look: {camera: {xyz: [0.4, 0, 1]}, joints: [0, 0, 0, 0, 0, 0]}\n", "only one of joints, camera and tip"},
      {"motion: {speed_override: 1.5}\n", "motion.speed_override: must lie in (0, 1]"},
      {"camera: {mount: ceiling}\n", "flange"},
      {"camera: {mount: fixed, pose: {xyz: [0.6475, 0, 0.1]}}\n",
       "cell.camera.pose: the camera at (0.647, 0.000, 0.100) m stands inside a wall or the floor of the bin"},
      {"camera: {mount: fixed, pose: {xyz: [0.9, 0.9, -0.02]}}\n", "stands inside the table"},
      {"camera: {mount: fixed, pose: {xyz: [0, -0.49, 0.002]}}\n", "stands inside a wall or the floor of the tray"},
      {"camera: {mount: fixed, pose: {xyz: [0, 0, 0.2]}}\n", "stands inside the arm"},
      {"camera: {housing: [0, 0, 0], pose: {xyz: [0, 0, -20 mm]}}\n", "stands inside the arm"},
      {"camera: {pose: {xyz: [0, 0, 60 mm]}}\n", "stands inside the tool"},
      {"cameras: [{name: west, pose: {xyz: [0.3425, 0, 0.1]}}]\n",
       "cell.cameras[0] (west).pose: the camera at (0.343, 0.000, 0.100) m stands inside a wall"},
      {"camera: {lens: {k1: -0.9}}\n", "cell.camera: lens: the distortion folds at radius 0.6"},
  };
  for (const auto& [extra, expected] : cases)
    EXPECT_NE(error_of(extra).find(expected), std::string::npos)
        << "expected: " << expected << "\ngot: " << error_of(extra);
}

TEST(BadCell, TrayOutOfReach) {
  Cell cell = cell_named("mz07_one_cup");
  cell.tray.X_WT.translation().y() = -0.9;
  try {
    cell.validate();
    FAIL() << "accepted";
  } catch (const SpecError& error) {
    EXPECT_NE(std::string(error.what()).find("cell.tray: unreachable"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace binpick

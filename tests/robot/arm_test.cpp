#include "robot/arm.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <numbers>
#include <sstream>

#include "core/error.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot_fixture.hpp"

namespace binpick {
namespace {

using namespace testing_robot;
constexpr double kDegree = std::numbers::pi / 180;

/// The MZ07 from the standard DH table of physical_models C1, built with another library: lengths in metres,
/// J1 d 345 a 50 alpha 90; J2 a 330; J3 a 45 alpha 90; J4 d 340 alpha -90; J5 alpha 90; J6 d 73.
KDL::Chain dh_chain() {
  using KDL::Frame, KDL::Joint, KDL::Segment;
  const double right = std::numbers::pi / 2;
  KDL::Chain chain;
  const double rows[6][3] = {{0.05, right, 0.345}, {0.33, 0, 0},  {0.045, right, 0},
                             {0, -right, 0.34},    {0, right, 0}, {0, 0, 0.073}};
  for (const auto& row : rows) chain.addSegment(Segment(Joint(Joint::RotZ), Frame::DH(row[0], row[1], row[2], 0)));
  return chain;
}

TEST(Arm, ForwardKinematicsAgreesWithKdlsDhTable) {
  const Arm arm = mz07();
  KDL::Chain chain = dh_chain();
  KDL::ChainFkSolverPos_recursive solver(chain);
  const Rng rng = Seed{7}.child("fk").rng();
  for (int k = 0; k < 1000; ++k) {
    const Vector6d q = random_joints(arm, rng.at(static_cast<std::uint64_t>(k)));
    // DH zero: upper arm horizontal; after the first twist of 90 degrees joints 2, 3 and 5 turn about -y.
    KDL::JntArray angles(6);
    angles(0) = q[0];
    angles(1) = std::numbers::pi / 2 - q[1];
    angles(2) = -q[2];
    angles(3) = q[3];
    angles(4) = -q[4];
    angles(5) = q[5];
    KDL::Frame frame;
    ASSERT_GE(solver.JntToCart(angles, frame), 0);
    const Pose X_RF = arm.forward(q);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(X_RF.translation()[i], frame.p(i), 1e-9) << "draw " << k;
    const Eigen::Vector3d z_F(frame.M(0, 2), frame.M(1, 2), frame.M(2, 2));
    EXPECT_LT((X_RF.linear().col(2) - z_F).norm(), 1e-9) << "draw " << k;
  }
}

TEST(Arm, ZeroPositionIsKnownOnPaper) {
  const Arm arm = mz07();
  const Pose X_RF = arm.forward(Vector6d::Zero());
  EXPECT_LT((X_RF.translation() - Eigen::Vector3d(0.05 + 0.34 + 0.073, 0, 0.345 + 0.33 + 0.045)).norm(), 1e-12);
  EXPECT_LT((X_RF.linear().col(2) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

TEST(Arm, OpwParametersAreThePublishedOnes) {
  const OpwParameters opw = *mz07().opw();
  EXPECT_NEAR(opw.a1, 0.050, 1e-9);
  EXPECT_NEAR(opw.a2, -0.045, 1e-9);
  EXPECT_NEAR(opw.b, 0, 1e-9);
  EXPECT_NEAR(opw.c1, 0.345, 1e-9);
  EXPECT_NEAR(opw.c2, 0.330, 1e-9);
  EXPECT_NEAR(opw.c3, 0.340, 1e-9);
  EXPECT_NEAR(opw.c4, 0.073, 1e-9);
}

TEST(Arm, LimitsAndSpeedsAreTheTables) {
  const double limits[6][3] = {{-170, 170, 450}, {-80, 135, 380},  {-180, 46, 520},
                               {-190, 190, 550}, {-120, 120, 550}, {-360, 360, 1000}};
  const Arm arm = mz07();
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(arm.limits()[i].lower / kDegree, limits[i][0], 1e-9);
    EXPECT_NEAR(arm.limits()[i].upper / kDegree, limits[i][1], 1e-9);
    EXPECT_NEAR(arm.limits()[i].speed / kDegree, limits[i][2], 1e-9);
  }
}

TEST(Arm, ReachIs723Millimetres) {  // V-C2
  const Arm arm = mz07();
  const Rng rng = Seed{7}.child("reach").rng();
  double reach = 0;
  for (int k = 0; k < 200000; ++k) {
    Vector6d q = random_joints(arm, rng.at(static_cast<std::uint64_t>(k)));
    q[3] = q[4] = 0;
    const Pose X_RF = arm.forward(q);
    const Eigen::Vector3d p_wrist = X_RF.translation() - 0.073 * X_RF.linear().col(2);
    reach = std::max(reach, p_wrist.head<2>().norm());
  }
  EXPECT_NEAR(reach, 0.723, 0.0005);
}

TEST(InverseKinematics, FindsTheJointsAndEveryBranchReproducesThePose) {  // V-C1
  const Arm arm = mz07();
  const Rng rng = Seed{7}.child("ik").rng();
  for (int k = 0; k < 10000; ++k) {
    const Vector6d q = random_joints(arm, rng.at(static_cast<std::uint64_t>(k)));
    const Pose X_RF = arm.forward(q);
    const std::vector<Vector6d> solutions = inverse_kinematics(arm, X_RF, q);
    ASSERT_FALSE(solutions.empty()) << "draw " << k;
    EXPECT_LT((solutions.front() - q).cwiseAbs().maxCoeff(), 1e-9) << "draw " << k;
    for (const Vector6d& other : solutions) {
      EXPECT_TRUE(arm.within_limits(other)) << "draw " << k;
      EXPECT_LT(largest_difference(arm.forward(other), X_RF), 1e-9) << "draw " << k;
    }
    for (const Vector6d& other : all_branches(arm, X_RF))
      EXPECT_LT(largest_difference(arm.forward(other), X_RF), 1e-9) << "draw " << k;
  }
}

TEST(InverseKinematics, GeometryHasEightBranches) {
  const Arm arm = mz07();
  const Vector6d q = (Vector6d() << 0.3, 0.2, -0.4, 0.5, 0.9, -0.3).finished();
  EXPECT_EQ(all_branches(arm, arm.forward(q)).size(), 8u);
}

TEST(InverseKinematics, SingularWristKeepsJointFour) {
  const Arm arm = mz07();
  const Vector6d q = (Vector6d() << 0.3, 0.2, -0.4, 1.1, 0, -0.7).finished();
  const std::vector<Vector6d> solutions = inverse_kinematics(arm, arm.forward(q), q);
  ASSERT_FALSE(solutions.empty());
  EXPECT_LT((solutions.front() - q).cwiseAbs().maxCoeff(), 1e-9);
  const std::vector<Vector6d> elsewhere = inverse_kinematics(arm, arm.forward(q), Vector6d::Zero());
  ASSERT_FALSE(elsewhere.empty());
  for (const Vector6d& other : elsewhere) EXPECT_LT(largest_difference(arm.forward(other), arm.forward(q)), 1e-9);
}

TEST(InverseKinematics, FullTurnsOfTheLastJointAreOffered) {
  const Arm arm = mz07();
  const Vector6d q = (Vector6d() << 0, 0.2, 0, 0, 0.9, 1.0).finished();
  int turned = 0;
  for (const Vector6d& other : inverse_kinematics(arm, arm.forward(q), q))
    turned += (other.head<5>() - q.head<5>()).norm() < 1e-9 && std::abs(other[5] - (1.0 - 2 * std::numbers::pi)) < 1e-9;
  EXPECT_EQ(turned, 1);
}

TEST(InverseKinematics, OutOfReachIsEmpty) {
  const Arm arm = mz07();
  EXPECT_TRUE(inverse_kinematics(arm, pose_from_xyz_rpy({1.2, 0, 0.4}, {0, 0, 0}), Vector6d::Zero()).empty());
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string error_of(const std::string& text) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "bad_arm.urdf";
  std::ofstream(file) << text;
  try {
    Arm::load(file.string());
  } catch (const AssetError& error) {
    return error.what();
  }
  return "";
}

TEST(BadUrdf, EachSaysWhatIsWrong) {
  std::ostringstream buffer;
  buffer << std::ifstream(asset("arms/mz07.urdf")).rdbuf();
  const std::string good = buffer.str();
  ASSERT_EQ(error_of(good), "");
  const std::pair<std::string, std::string> cases[] = {
      {"", "not a readable URDF"},
      {good.substr(0, good.size() / 2), "not a readable URDF"},
      {replaced(good, "<joint name=\"J3\" type=\"revolute\">", "<joint name=\"J3\" type=\"fixed\">"),
       "has 5 revolute joints"},
      {replaced(good, "<joint name=\"J3\" type=\"revolute\">", "<joint name=\"J3\" type=\"prismatic\">"),
       "'J3' is not revolute"},
      {replaced(good, "velocity=\"7.85", "velocity=\"-7.85"), "'J1' has no positive speed limit"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_NE(error_of(text).find(expected), std::string::npos)
        << "expected: " << expected << "\ngot: " << error_of(text);
  }
}

TEST(NoClosedForm, IsSaidWithTheReason) {
  std::ostringstream buffer;
  buffer << std::ifstream(asset("arms/mz07.urdf")).rdbuf();
  const std::string good = buffer.str();
  const std::pair<std::string, std::string> cases[] = {
      {replaced(good, "<origin xyz=\"0.055 0 0\"", "<origin xyz=\"0.055 0.012 0\""),
       "4, 5 and 6 miss one common point by 12"},
      {replaced(good, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0.5\"/>"), "joints 1 and 2 are not perpendicular"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string file = testing::TempDir() + "odd_arm.urdf";
    std::ofstream(file) << text;
    const Arm arm = Arm::load(file);
    EXPECT_FALSE(arm.opw());
    EXPECT_NE(arm.why_numeric().find(expected), std::string::npos) << arm.why_numeric();
    const Vector6d q = (Vector6d() << 0.3, 0.2, -0.4, 0.5, 0.9, -0.3).finished();
    const std::vector<Vector6d> solutions = inverse_kinematics(arm, arm.forward(q), q);
    ASSERT_FALSE(solutions.empty());
    EXPECT_LT((solutions.front() - q).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(BadUrdf, MissingFileAndMissingMesh) {
  EXPECT_THROW(Arm::load("/nowhere/arm.urdf"), AssetError);
  std::ostringstream buffer;
  buffer << std::ifstream(asset("arms/mz07.urdf")).rdbuf();
  std::string text = buffer.str();
  const std::string from = "<geometry><box size=\"0.15 0.15 0.12\"/></geometry>\n    </collision>";
  EXPECT_NE(
      error_of(replaced(text, from, "<geometry><mesh filename=\"meshes/gone.stl\"/></geometry>\n    </collision>"))
          .find("'meshes/gone.stl' that does not exist"),
      std::string::npos);
  EXPECT_NE(
      error_of(replaced(text, from, "<geometry><mesh filename=\"../../etc/x.stl\"/></geometry>\n    </collision>"))
          .find("leaves the folder of the URDF"),
      std::string::npos);
}

}  // namespace
}  // namespace binpick

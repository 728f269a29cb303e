// Arms of five makes, each with the habits of its maker's URDF: forward kinematics against KDL, closed and numeric
// inverse kinematics, reach (physical_models C2, C3; V-C1, V-C2).
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <fstream>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <numbers>
#include <sstream>

#include "robot/inverse_kinematics.hpp"
#include "robot/numeric_ik.hpp"
#include "robot_fixture.hpp"

namespace binpick {
namespace {

using namespace testing_robot;
constexpr double kPi = std::numbers::pi;

struct ForeignArm {
  const char* file;
  const char* tip;
  bool closed_form, exact;
};
std::ostream& operator<<(std::ostream& out, const ForeignArm& arm) { return out << arm.file; }

const ForeignArm kArms[] = {
    {"mz07.urdf", "flange", true, true},        {"kr6_r900.urdf", "tool0", true, true},
    {"lrmate_200id.urdf", "tool0", true, true}, {"irb1200_description/urdf/irb1200_5_90.urdf", "tool0", true, true},
    {"tx2_60l.urdf", "link_6", true, false},    {"ur5e.urdf", "tool0", false, false}};

std::string text_of(const std::string& file) {
  std::ostringstream buffer;
  buffer << std::ifstream(file).rdbuf();
  return buffer.str();
}

/// Largest difference of two joint positions, whole turns ignored.
double turned_difference(const Vector6d& a, const Vector6d& b) {
  double most = 0;
  for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(std::remainder(a[i] - b[i], 2 * kPi)));
  return most;
}

KDL::Frame frame_of(const urdf::Pose& pose) {
  double x, y, z, w;
  pose.rotation.getQuaternion(x, y, z, w);
  return {KDL::Rotation::Quaternion(x, y, z, w), KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

/// The chain as the file states it, one segment per joint, fixed ones included: nothing merged, nothing of ours.
KDL::Chain chain_of(const std::string& file, const std::string& tip) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text_of(file));
  std::vector<urdf::JointSharedPtr> joints;
  for (auto link = model->getLink(tip); link->parent_joint; link = link->getParent())
    joints.insert(joints.begin(), link->parent_joint);
  KDL::Chain chain;
  for (const auto& joint : joints) {
    const KDL::Frame frame = frame_of(joint->parent_to_joint_origin_transform);
    if (joint->type == urdf::Joint::FIXED) {
      chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), frame));
      continue;
    }
    const KDL::Vector axis(joint->axis.x, joint->axis.y, joint->axis.z);
    chain.addSegment(KDL::Segment(KDL::Joint("j", frame.p, frame.M * axis, KDL::Joint::RotAxis), frame));
  }
  return chain;
}

/// Smallest singular value of the Jacobian (m and rad per rad), by differences: a pose rounded by e moves the joints by
/// up to e over this.
double least_gain(const Arm& arm, const Vector6d& q) {
  constexpr double kStep = 1e-6;
  Matrix6d J;
  for (int i = 0; i < 6; ++i) {
    Vector6d before = q, after = q;
    before[i] -= kStep, after[i] += kStep;
    const Pose X_1 = arm.forward(before), X_2 = arm.forward(after);
    J.col(i) << (X_2.translation() - X_1.translation()) / (2 * kStep),
        log_so3(X_2.linear() * X_1.linear().transpose()) / (2 * kStep);
  }
  return J.jacobiSvd().singularValues()[5];
}

class EveryArm : public testing::TestWithParam<ForeignArm> {
 protected:
  Arm arm = Arm::load(asset(std::string("arms/") + GetParam().file));
};
INSTANTIATE_TEST_SUITE_P(Arms, EveryArm, testing::ValuesIn(kArms));

TEST_P(EveryArm, IsReadAsItsMakerMeant) {
  EXPECT_EQ(arm.flange_name(), GetParam().tip);
  EXPECT_EQ(arm.opw().has_value(), GetParam().closed_form) << arm.why_numeric();
  EXPECT_EQ(arm.opw() && arm.opw_is_exact(), GetParam().exact);
  // F has its z along the last axis, out of the flange: it turns about it.
  const Vector6d q = random_joints(arm, Seed{7}.child("tip").rng());
  Vector6d turned = q;
  turned[5] += 0.5;
  EXPECT_LT((arm.forward(q).linear().col(2) - arm.forward(turned).linear().col(2)).norm(), 1e-5);
  for (std::size_t l = 0; l < 7; ++l) EXPECT_FALSE(arm.link_shapes()[l].empty() && l < 6) << arm.link_names()[l];
}

TEST_P(EveryArm, ForwardKinematicsAgreesWithKdlsChainOfTheSameFile) {
  const KDL::Chain chain = chain_of(asset(std::string("arms/") + GetParam().file), GetParam().tip);
  KDL::ChainFkSolverPos_recursive solver(chain);
  const Rng rng = Seed{7}.child("fk").rng();
  for (int k = 0; k < 1000; ++k) {
    const Vector6d q = random_joints(arm, rng.at(static_cast<std::uint64_t>(k)));
    KDL::JntArray angles(6);
    angles.data = q;
    KDL::Frame frame;
    ASSERT_GE(solver.JntToCart(angles, frame), 0);
    const Pose X_RF = arm.forward(q);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(X_RF.translation()[i], frame.p(i), 1e-9) << "draw " << k;
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(X_RF.linear()(i, j), frame.M(i, j), 1e-9) << "draw " << k;
    }
  }
}

TEST_P(EveryArm, ClosedFormFindsTheJointsAndEveryBranchReproducesThePose) {  // V-C1, 1e5 draws over the five arms
  if (!arm.opw()) GTEST_SKIP() << arm.why_numeric();
  const Rng rng = Seed{7}.child("closed_form").rng();
  int singular = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vector6d q = random_joints(arm, rng.at(static_cast<std::uint64_t>(k)));
    const Pose X_RF = arm.forward(q);
    const std::vector<Vector6d> solutions = inverse_kinematics(arm, X_RF, q);
    ASSERT_FALSE(solutions.empty()) << "draw " << k;
    const double error = (solutions.front() - q).cwiseAbs().maxCoeff();
    // By chance a draw lies a micrometre from a singularity: there the rounding of the pose itself moves the joints.
    if (error >= 1e-9) {
      ++singular;
      EXPECT_LT(error * least_gain(arm, q), 1e-14) << "draw " << k;
    }
    for (const Vector6d& branch : all_branches(arm, X_RF))
      ASSERT_LT(largest_difference(arm.forward(branch), X_RF), 1e-9) << "draw " << k;
  }
  EXPECT_LE(singular, 2);
}

TEST_P(EveryArm, NumericSearchFindsTheJointsAndDistinctBranches) {
  const Rng rng = Seed{7}.child("numeric").rng();
  constexpr int kDraws = 40;
  int branches = 0, restarts = 0, converged = 0, closed = 0, missed = 0;
  for (int k = 0; k < kDraws; ++k) {
    const Vector6d q = random_joints(arm, rng.at(static_cast<std::uint64_t>(k)));
    const Pose X_RF = arm.forward(q);
    const NumericBranches found = arm.numeric().search(X_RF, Vector6d::Constant(0.1));
    bool own = false;
    for (std::size_t i = 0; i < found.q.size(); ++i) {
      EXPECT_LT(largest_difference(arm.forward(found.q[i]), X_RF), 1e-9) << "draw " << k;
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT(turned_difference(found.q[i], found.q[j]), 1e-3) << "draw " << k;
      own |= turned_difference(found.q[i], q) < 1e-6;
    }
    missed += !own;
    branches += static_cast<int>(found.q.size());
    restarts += found.restarts;
    converged += found.converged;
    if (arm.opw()) closed += static_cast<int>(all_branches(arm, X_RF).size());
  }
  RecordProperty("branches_per_pose", std::to_string(static_cast<double>(branches) / kDraws));
  RecordProperty("restarts_per_pose", std::to_string(static_cast<double>(restarts) / kDraws));
  RecordProperty("share_converged", std::to_string(static_cast<double>(converged) / restarts));
  EXPECT_LE(missed, 1);  // measured: 1 of 200 poses of the UR5e, none of 1000 of the others
  if (arm.opw()) {
    EXPECT_LE(branches, closed) << "more branches than there are";
    EXPECT_GE(branches, 0.97 * closed);
  }
}

TEST_P(EveryArm, NumericSearchIsRepeatable) {
  const Arm again = Arm::load(asset(std::string("arms/") + GetParam().file));
  const Pose X_RF = arm.forward(random_joints(arm, Seed{7}.child("repeat").rng()));
  const NumericBranches one = arm.numeric().search(X_RF, Vector6d::Zero());
  const NumericBranches two = again.numeric().search(X_RF, Vector6d::Zero());
  ASSERT_FALSE(one.q.empty());
  EXPECT_EQ(one.q, two.q);
  EXPECT_EQ(one.restarts, two.restarts);
}

TEST_P(EveryArm, SingularWristIsSolvedNearAndFar) {
  const Rng rng = Seed{7}.child("singular").rng();
  for (int k = 0; k < 20; ++k) {
    Vector6d q = random_joints(arm, rng.at(static_cast<std::uint64_t>(k)));
    // The wrist is stretched: axes 4 and 6 are parallel, and the solutions are a continuum.
    q[4] = arm.opw() ? arm.opw()->sign[4] * arm.opw()->offset[4] : 0;
    const Pose X_RF = arm.forward(q);
    const std::vector<Vector6d> at_home = inverse_kinematics(arm, X_RF, q);
    ASSERT_FALSE(at_home.empty()) << "draw " << k;
    EXPECT_LT((at_home.front() - q).cwiseAbs().maxCoeff(), 1e-4) << "draw " << k;
    const std::vector<Vector6d> elsewhere = inverse_kinematics(arm, X_RF, Vector6d::Constant(0.2));
    EXPECT_FALSE(elsewhere.empty()) << "draw " << k;
    for (const Vector6d& other : elsewhere)
      EXPECT_LT(largest_difference(arm.forward(other), X_RF), 1e-6) << "draw " << k;
    const auto followed = following_solution(arm, X_RF, q);
    ASSERT_TRUE(followed) << "draw " << k;
    EXPECT_LT((*followed - q).cwiseAbs().maxCoeff(), 1e-4) << "draw " << k;
  }
}

TEST_P(EveryArm, OutOfReachIsEmptyAndSoonSaid) {
  const Pose far = pose_from_xyz_rpy({1.8, 0, 0.4}, {0, 0, 0}),
             close = pose_from_xyz_rpy({1.05, 0, 0.4}, {0.3, 0.2, 0});
  EXPECT_EQ(arm.numeric().search(far, Vector6d::Zero()).restarts, 0);
  EXPECT_LE(arm.numeric().search(close, Vector6d::Zero()).restarts, NumericIk::kHopeless);
  EXPECT_TRUE(inverse_kinematics(arm, close, Vector6d::Zero()).empty());
  EXPECT_FALSE(has_solution(arm, close, Vector6d::Zero()));
}

TEST(UrType, HasEightBranchesWherePaperSaysSo) {
  // Wrist bent, elbow bent, shoulder clear of its cylinder: shoulder x elbow x wrist.
  const Arm arm = Arm::load(asset("arms/ur5e.urdf"));
  const Vector6d q = (Vector6d() << 0.3, -1.9, 1.6, -1.2, -1.4, 0.4).finished();
  EXPECT_EQ(all_branches(arm, arm.forward(q)).size(), 8u);
  // Every joint may turn twice: the nearest of 8 x 2^5 (the elbow turns once) is q itself.
  const std::vector<Vector6d> all = inverse_kinematics(arm, arm.forward(q), q);
  EXPECT_GE(all.size(), 8u * 32u);
  EXPECT_LT((all.front() - q).cwiseAbs().maxCoeff(), 1e-9);
}

/// Largest distance of the wrist's centre from joint 1's axis, over random positions with a straight wrist.
double sampled_reach(const Arm& arm) {
  const Rng rng = Seed{7}.child("reach").rng();
  double reach = 0;
  for (int k = 0; k < 60000; ++k) {
    const Vector6d q = random_joints(arm, rng.at(static_cast<std::uint64_t>(k)));
    const Pose X_OE = arm.opw()->X_RO.inverse() * arm.forward(q) * arm.opw()->X_EF.inverse();
    reach = std::max(reach, (X_OE * Eigen::Vector3d(0, 0, -arm.opw()->c4)).head<2>().norm());
  }
  return reach;
}

TEST(Reach, IsTheCatalogues) {  // V-C2
  EXPECT_NEAR(sampled_reach(Arm::load(asset("arms/kr6_r900.urdf"))), 0.901, 0.001);
  EXPECT_NEAR(sampled_reach(Arm::load(asset("arms/lrmate_200id.urdf"))), 0.717, 0.001);
  EXPECT_NEAR(sampled_reach(Arm::load(asset("arms/irb1200_description/urdf/irb1200_5_90.urdf"))), 0.901, 0.001);
  EXPECT_NEAR(sampled_reach(Arm::load(asset("arms/tx2_60l.urdf"))), 0.920 - 0.070, 0.001);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

Arm arm_of(const std::string& text) {
  const std::string file = testing::TempDir() + "foreign_arm.urdf";
  std::ofstream(file) << text;
  return Arm::load(file);
}

TEST(Reach, OfTheSisterModelsIsTheCatalogues) {  // V-C2, lengths of physical_models C1
  const std::string mz07 = text_of(asset("arms/mz07.urdf"));
  const std::string upper = "<origin xyz=\"0 0 0.33\" rpy=\"0 0 0\"/>\n    <axis", fore = "<origin xyz=\"0.25 0 0\"";
  const std::string longer = replaced(mz07, upper, "<origin xyz=\"0 0 0.42\" rpy=\"0 0 0\"/>\n    <axis");
  EXPECT_NEAR(sampled_reach(arm_of(replaced(longer, fore, "<origin xyz=\"0.35 0 0\""))), 0.912, 0.001);
  std::string small = replaced(mz07, upper, "<origin xyz=\"0 0 0.26\" rpy=\"0 0 0\"/>\n    <axis");
  small = replaced(small, fore, "<origin xyz=\"0.19 0 0\"");
  small = replaced(small, "<origin xyz=\"0.09 0 0.045\"", "<origin xyz=\"0.09 0 0.025\"");
  small = replaced(small, "<origin xyz=\"0.05 0 0.148\" rpy=\"0 0 0\"/>\n    <axis",
                   "<origin xyz=\"0 0 0.143\" rpy=\"0 0 0\"/>\n    <axis");
  EXPECT_NEAR(sampled_reach(arm_of(small)), 0.541, 0.001);
}

}  // namespace
}  // namespace binpick

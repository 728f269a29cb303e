// Arms of five makes, each with the habits of its maker's URDF: forward kinematics against KDL, closed and numeric
// inverse kinematics, reach (physical_models C2, C3; V-C1, V-C2).
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <fstream>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>

#include "foreign_arms.hpp"

namespace binpick {
namespace {

using namespace testing_robot;
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

INSTANTIATE_TEST_SUITE_P(Arms, EveryArm, testing::ValuesIn(kArms));

class WithClosedForm : public EveryArm {};
INSTANTIATE_TEST_SUITE_P(Arms, WithClosedForm, testing::ValuesIn(closed_form_arms()));

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

TEST_P(WithClosedForm, FindsTheJointsAndEveryBranchReproducesThePose) {  // V-C1, 1e5 draws over the five arms
  ASSERT_TRUE(arm.opw()) << arm.why_numeric();
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

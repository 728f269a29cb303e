// Symmetries as BOP lists them, and back.
#include "evaluation/bop_symmetry.hpp"

#include <gtest/gtest.h>

#include "tests/evaluation/example_parts.hpp"

namespace binpick {
namespace {

double worst_twin(const Symmetry& a, const std::vector<Pose>& members) {
  double worst = 0;
  for (const Pose& S : members) {
    const Pose twin = nearest_equivalent(Pose::Identity(), S, a);
    worst = std::max({worst, angle_between(twin.linear(), S.linear()), (twin.inverse() * S).translation().norm()});
  }
  return worst;
}

TEST(BopSymmetry, EveryPartComesBackAsItWas) {
  for (const Part& part : examples::all()) {
    const Symmetry back = closed_form(bop_symmetries(part.symmetry));
    EXPECT_EQ(back.axis.has_value() && !back.center_P, part.symmetry.axis.has_value()) << part.name;
    EXPECT_EQ(back.center_P.has_value(), part.symmetry.center_P.has_value()) << part.name;
    EXPECT_LT(worst_twin(back, sampled_group(part.symmetry, 12)), 1e-9) << part.name;
    EXPECT_LT(worst_twin(part.symmetry, sampled_group(back, 12)), 1e-9) << part.name;
  }
}

TEST(BopSymmetry, TheToolkitTakes315Turns) {
  const BopSymmetries listed = bop_symmetries(examples::disc().symmetry);
  EXPECT_EQ(listed.discrete.size(), 1u);
  const std::vector<Pose> group = toolkit_group(listed);
  EXPECT_EQ(group.size(), 2u * 315u);
  EXPECT_TRUE(group.front().isApprox(Pose::Identity()));
  EXPECT_LT(worst_twin(examples::disc().symmetry, group), 1e-9);
  EXPECT_NEAR(angle_between(group[0].linear(), group[1].linear()), 2 * M_PI / 315, 1e-12);
}

TEST(BopSymmetry, TwoAxesThatMeetAreASphere) {
  BopSymmetries listed;
  listed.continuous = {{{0, 0, 2}, {0.01, 0, 0.5}}, {{0, 1, 0}, {0.01, 0.7, 0.03}}};
  const Symmetry sphere = closed_form(listed);
  ASSERT_TRUE(sphere.center_P);
  EXPECT_LT((*sphere.center_P - Eigen::Vector3d(0.01, 0, 0.03)).norm(), 1e-12);
  listed.continuous[1].offset.x() = 0.02;  // they pass each other: no group, taken as listed
  const Symmetry list = closed_form(listed);
  EXPECT_FALSE(list.center_P || list.axis);
  EXPECT_EQ(list.finite.size(), 2u * 315u);
}

// A member that moves the axis does not belong to its group.
TEST(BopSymmetry, AMemberThatMovesTheAxisLeavesTheListAsItIs) {
  BopSymmetries listed;
  listed.continuous = {{{0, 0, 1}, {0, 0, 0}}};
  listed.discrete = {examples::turn({0, 0, 0}, {1, 0, 0}, M_PI / 2)};
  EXPECT_FALSE(closed_form(listed).axis);
  listed.discrete = {examples::turn({0, 0, 0.2}, {1, 0, 0}, M_PI)};
  EXPECT_TRUE(closed_form(listed).axis);
}

TEST(BopSymmetry, InAShiftedFrame) {
  for (const Part& part : examples::all()) {
    const Pose X_PO = examples::moved_to(0.03, -0.02, 0.05);
    const Symmetry shifted = symmetry_in(part.symmetry, X_PO);
    Rng rng = Seed{1}.child(part.name).rng();
    const Pose S_P = examples::random_member(part.symmetry, rng);
    EXPECT_LT(worst_twin(shifted, {X_PO.inverse() * S_P * X_PO}), 1e-9) << part.name;
  }
}

}  // namespace
}  // namespace binpick

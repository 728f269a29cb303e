#include "robot/pick_sites.hpp"

#include <gtest/gtest.h>

#include "robot_fixture.hpp"

namespace binpick {
namespace {

using namespace testing_robot;

Part part_named(const std::string& name) { return load_part(read_part_spec(asset("parts/" + name + "/part.yaml"))); }

std::unique_ptr<Gripper> suction(const std::string& yaml) {
  std::unique_ptr<Gripper> gripper = make_gripper("suction");
  read_yaml_text(yaml, "gripper.yaml", "", [&](ConfigVisitor& v) { gripper->visit(v); });
  gripper->validate();
  return gripper;
}

TEST(PickSites, BearingIsHeldAtItsCentreFromBothFaces) {
  const auto gripper = suction("preset: three_cups\n");
  const PickSites found = find_pick_sites(part_named("bearing_6914"), *gripper);
  ASSERT_EQ(found.sites.size(), 2u) << found.why_none;
  double faces = 0;
  for (const PickSite& site : found.sites) {
    EXPECT_TRUE(site.free_spin);
    EXPECT_LT(site.X_PK.translation().head<2>().norm(), 1e-9);                         // on the axis, over the hole
    EXPECT_NEAR(std::abs(site.X_PK.translation().z()), 0.008, 1e-5);                   // in the face's plane
    EXPECT_NEAR(site.X_PK.linear().col(2).dot(site.X_PK.translation()), 0.008, 1e-5);  // facing outwards
    EXPECT_GT(site.quality, 0.3);
    faces += site.X_PK.translation().z();
  }
  EXPECT_NEAR(faces, 0, 1e-5);
}

TEST(PickSites, OneCupOnTheBearingsLandWouldPeel) {
  const auto gripper = suction("cups: [{radius: 6 mm}]\n");
  const Part part = part_named("bearing_6914");
  const PickSites found = find_pick_sites(part, *gripper);
  // What stays are places on the outer cylinder, with the mass centre straight below the cup.
  for (const PickSite& site : found.sites) EXPECT_LT(std::abs(site.X_PK.linear()(2, 2)), 0.1);
  EXPECT_GT(found.weak, 0);
  PickSiteConfig keep;
  keep.keep_weak = true;
  int on_land = 0;
  for (const PickSite& site : find_pick_sites(part, *gripper, keep).sites)
    on_land += std::abs(site.X_PK.linear()(2, 2)) > 0.99;
  EXPECT_GT(on_land, 0);
}

TEST(PickSites, ToolTooHeavyLoadedSaysSo) {
  const auto gripper = suction("cups: [{radius: 2 mm}]\n");
  const PickSites found = find_pick_sites(part_named("bracket_l"), *gripper);
  EXPECT_TRUE(found.sites.empty());
  EXPECT_NE(found.why_none.find("peel"), std::string::npos);
}

class SmallParts : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Parts, SmallParts, testing::Values("bracket_l", "tee"));

TEST_P(SmallParts, OneCupFindsSealedSitesNearTheMassCentreOnSeveralSides) {
  const Part part = part_named(GetParam());
  const auto gripper = suction("preset: one_cup\n");
  const PickSites found = find_pick_sites(part, *gripper);
  ASSERT_GE(found.sites.size(), 4u) << found.why_none;
  const MeshQuery query(part.mesh_P);
  int up = 0, down = 0;
  for (const PickSite& site : found.sites) {
    const auto samples = probe_mesh(query, *gripper, tip_at_site(Pose::Identity(), site), 0.2, 0.1);
    EXPECT_TRUE(gripper->judge(samples).sealed);
    EXPECT_GE(site.quality, 0);
    EXPECT_LE(site.quality, 1);
    // Weight times lever within what the lip holds against peeling.
    const HoldLimits limits = gripper->judge(samples).limits;
    const double weight = part.mass.mass * 9.81, lever = (site.X_PK.inverse() * part.mass.center_P).head<2>().norm();
    EXPECT_LT(weight * lever, (limits.pull - weight) * gripper->cups().front().radius);
    const double z = site.X_PK.linear()(2, 2);
    up += z > 0.9;
    down += z < -0.9;
  }
  EXPECT_GT(up, 0);
  EXPECT_GT(down, 0);
}

TEST(PickSites, SameTwice) {
  const Part part = part_named("tee");
  const auto gripper = suction("preset: one_cup\n");
  const PickSites a = find_pick_sites(part, *gripper), b = find_pick_sites(part, *gripper);
  ASSERT_EQ(a.sites.size(), b.sites.size());
  for (std::size_t i = 0; i < a.sites.size(); ++i) EXPECT_EQ(a.sites[i].X_PK.matrix(), b.sites[i].X_PK.matrix());
}

TEST(TurnOrder, OfTheTools) {
  EXPECT_EQ(turn_order(*suction("preset: one_cup\n")), 0);
  EXPECT_EQ(turn_order(*suction("preset: three_cups\n")), 3);
  EXPECT_EQ(turn_order(*suction("cups: [{pose: {xyz: [10 mm, 0, 0]}}, {pose: {xyz: [-10 mm, 0, 0]}}]\n")), 2);
  EXPECT_EQ(turn_order(*suction("cups: [{pose: {xyz: [10 mm, 0, 0]}}, {pose: {xyz: [-15 mm, 0, 0]}}]\n")), 1);
}

}  // namespace
}  // namespace binpick

// Views that do not hold the answer, on parts for which paper and pencil know them.
#include "perception/view_ambiguity.hpp"

#include <gtest/gtest.h>

#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

const StatedNoise kStereo{0, 0, 0.08 / (430.1 * 0.05), 1};

/// The part's face with outward normal `n_P` towards the camera, 0.55 m away, tilted by `tilt` about x of C.
Pose facing(const Part& part, const Eigen::Vector3d& n_P, double turn, double tilt = 0) {
  Pose X = Pose::Identity();
  X.linear() = exp_so3({tilt, 0, 0}) * exp_so3({0, 0, turn}) * rotation_with_z(-n_P).transpose();
  X.translation() = Eigen::Vector3d(0.02, -0.01, 0.55) - X.linear() * part.box_center_P;
  return X;
}

TEST(SelfOverlaps, TheBracketsBaseFromBehindIsItsHalfTurnAboutTheMiddle) {
  const Part bracket = bracket_part();
  const auto overlaps = self_overlaps(bracket.mesh_P, bracket.symmetry, bracket.diameter);
  ASSERT_FALSE(overlaps.empty());
  const Pose half = pose_from(exp_so3({0, 0, std::numbers::pi}), {0.09, 0, 0});  // about the line x = 45 mm, y = 0
  const auto vertices = hull_vertices(bracket.mesh_P);
  double nearest = 1;
  for (const SelfOverlap& o : overlaps) {
    EXPECT_TRUE(is_rigid(o.T, 1e-6));
    EXPECT_TRUE(o.alike >= 0.5 && o.alike <= 1) << o.alike;
    EXPECT_GT(largest_shift(o.T, bracket.symmetry, vertices), 0.1 * bracket.diameter);
    double worst = 0;
    for (const Eigen::Vector3d& p : vertices) worst = std::max(worst, (o.T * p - half * p).norm());
    nearest = std::min(nearest, worst);
  }
  EXPECT_LT(nearest, 0.0015);
}

TEST(SelfOverlaps, ABoxThatKnowsItsSymmetryHasNoneAndOneThatDoesNotHasAll) {
  const TriangleMesh mesh = mesh_of(Primitive::box({0.09, 0.06, 0.006}));
  SymmetrySpec dihedral;
  dihedral.type = "dihedral";
  const Part known = part_from("known", mesh, dihedral), unknown = part_from("unknown", mesh, {});
  for (const SelfOverlap& o : self_overlaps(known.mesh_P, known.symmetry, known.diameter)) EXPECT_LT(o.alike, 0.9);
  int whole = 0;
  for (const SelfOverlap& o : self_overlaps(unknown.mesh_P, unknown.symmetry, unknown.diameter))
    whole += o.alike > 0.97;
  EXPECT_EQ(whole, 3);  // the half turns about x, y and z
}

TEST(SelfOverlaps, ASphereAndARingHaveNothingThatLooksAlike) {
  const Part ring = ring_part();
  for (const SelfOverlap& o : self_overlaps(ring.mesh_P, ring.symmetry, ring.diameter)) EXPECT_LT(o.alike, 0.9);
  EXPECT_TRUE(self_overlaps({}, {}, 0.1).empty());
}

TEST(AmbiguousViews, TheBracketFromBehindHidesWhichWayItStandsAndFromInsideShowsIt) {
  const Part bracket = bracket_part();
  const AmbiguousViews views(bracket);
  const PinholeCamera camera;
  for (const double turn : {0.0, 0.7, 2.0, 4.0}) {
    const Pose behind = facing(bracket, -Eigen::Vector3d::UnitZ(), turn);
    EXPECT_TRUE(views.ambiguous(behind, camera, kStereo)) << turn;
    const auto rival = views.nearest_rival(behind, camera, kStereo);
    EXPECT_GT(mssd(bracket, rival.X_CP, behind, hull_vertices(bracket.mesh_P)), 0.1 * bracket.diameter);
    EXPECT_FALSE(views.ambiguous(facing(bracket, Eigen::Vector3d::UnitZ(), turn), camera, kStereo)) << turn;
    EXPECT_FALSE(views.ambiguous(facing(bracket, {-1, 0, -1}, turn), camera, kStereo)) << turn;
  }
}

TEST(AmbiguousViews, FromBehindATiltThatShowsTheUprightResolvesIt) {
  const Part bracket = bracket_part();
  const AmbiguousViews views(bracket);
  const PinholeCamera camera;
  int resolved = 0;
  for (const double turn : {0.0, 1.57, 3.14, 4.71})
    resolved += !views.ambiguous(facing(bracket, -Eigen::Vector3d::UnitZ(), turn, 0.5), camera, kStereo);
  EXPECT_GE(resolved, 1);  // the side on which the upright's outer face comes into view
}

TEST(AmbiguousViews, NoiseHidesWhatAGoodSensorShows) {
  // A step of 2 mm on one half of a box: an exact sensor sees it, one of 5 mm standard deviation does not.
  TriangleMesh mesh = mesh_of(Primitive::box({0.08, 0.05, 0.02}));
  append(mesh, mesh_of(Primitive::box({0.04, 0.05, 0.002}, pose_from(Eigen::Matrix3d::Identity(), {0.02, 0, 0.011}))));
  const Part box = part_from("step", mesh, {});
  const AmbiguousViews views(box);
  const Pose X = facing(box, Eigen::Vector3d::UnitZ(), 0.3);
  EXPECT_FALSE(views.ambiguous(X, PinholeCamera(), {0.0001, 0, 0, 0}));
  EXPECT_TRUE(views.ambiguous(X, PinholeCamera(), {0.005, 0, 0, 0}));
}

TEST(AmbiguousViews, WhatCoversThePartCanHideTheAnswer) {
  const Part bracket = bracket_part();
  const AmbiguousViews views(bracket);
  const PinholeCamera camera;
  const Pose X = facing(bracket, Eigen::Vector3d::UnitZ(), 0.2);
  ZBuffer buffer(camera);
  buffer.draw(mesh_of(Primitive::box({2, 2, 0.01}, pose_from(Eigen::Matrix3d::Identity(), {0, 0, 0.7}))),
              Pose::Identity(), 1);
  buffer.draw(bracket.mesh_P, X, 0);
  EXPECT_FALSE(views.ambiguous(X, camera, kStereo, &buffer.result().depth));
  // A bar in front of the upright and one in front of the boss: what is left of the base turns into itself.
  buffer.draw(mesh_of(Primitive::box({0.05, 0.09, 0.005}, X * pose_from(Eigen::Matrix3d::Identity(), {0, 0, 0.08}))),
              Pose::Identity(), 2);
  buffer.draw(
      mesh_of(Primitive::box({0.07, 0.09, 0.005}, X * pose_from(Eigen::Matrix3d::Identity(), {0.085, 0, 0.08}))),
      Pose::Identity(), 2);
  EXPECT_TRUE(views.ambiguous(X, camera, kStereo, &buffer.result().depth));
}

}  // namespace
}  // namespace binpick

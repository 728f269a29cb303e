// Resting poses against closed forms: cuboids, cylinders, and solids that topple.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/primitive.hpp"
#include "core/random.hpp"
#include "core/stable_poses.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;

Symmetry dihedral(int order) {
  SymmetrySpec spec;
  spec.type = "dihedral";
  spec.order = order;
  return make_symmetry(spec);
}

Symmetry revolution(bool flip) {
  SymmetrySpec spec;
  spec.type = "revolution";
  spec.flip = flip;
  return make_symmetry(spec);
}

double total(const std::vector<StablePose>& poses) {
  double sum = 0;
  for (const StablePose& pose : poses) sum += pose.probability;
  return sum;
}

std::vector<Eigen::Vector3d> cuboid(double square, double length) {
  return mesh_of(Primitive::box({square, square, length})).vertices;
}

TEST(StablePoses, CuboidsFollowTheClosedForm) {
  // Square ends y, length x: P(on an end) = (2 / pi) asin(1 / (1 + (x / y)^2)).
  for (const double ratio : {0.47, 0.75, 1.44, 2.65}) {
    const std::vector<StablePose> poses = stable_poses(cuboid(0.03, 0.03 * ratio), {0, 0, 0}, dihedral(4));
    ASSERT_EQ(poses.size(), 2u) << ratio;
    const double expected = 2 / kPi * std::asin(1 / (1 + ratio * ratio));
    for (const StablePose& pose : poses) {
      const bool on_end = std::abs(pose.down_P.z()) > 0.99;
      EXPECT_NEAR(pose.probability, on_end ? expected : 1 - expected, 1e-12) << ratio;
      EXPECT_EQ(pose.faces, on_end ? 2 : 4);
      EXPECT_NEAR(pose.height, on_end ? 0.015 * ratio : 0.015, 1e-12);
      EXPECT_NEAR(pose.tilt, on_end ? std::atan(1 / ratio) : std::atan(std::min(1.0, ratio)), 1e-9);
    }
    EXPECT_NEAR(total(poses), 1, 1e-12);
  }
}

TEST(StablePoses, WithoutSymmetryEachFaceIsItsOwn) {
  const std::vector<StablePose> poses = stable_poses(cuboid(0.03, 0.03), {0, 0, 0}, {});
  ASSERT_EQ(poses.size(), 6u);
  for (const StablePose& pose : poses) EXPECT_NEAR(pose.probability, 1.0 / 6, 1e-12);
}

TEST(StablePoses, CylindersFollowTheClosedForm) {
  // Height h, diameter D, eta = h / D: P(side) = eta / sqrt(1 + eta^2); 720 facets.
  for (const double eta : {0.16, 0.3536, 1.0, 3.0}) {
    const TriangleMesh mesh = mesh_of(Primitive::cylinder(0.01, 0.02 * eta), 720);
    for (const Symmetry& symmetry : {revolution(true), Symmetry()}) {  // facets are one pose, symmetric or not
      const std::vector<StablePose> poses = stable_poses(mesh.vertices, {0, 0, 0}, symmetry);
      ASSERT_EQ(poses.size(), symmetry.trivial() ? 3u : 2u) << eta;
      const auto side =
          std::find_if(poses.begin(), poses.end(), [](const auto& p) { return std::abs(p.down_P.z()) < 0.5; });
      ASSERT_NE(side, poses.end());
      EXPECT_NEAR(side->probability, eta / std::sqrt(1 + eta * eta), 1e-4) << eta;
      EXPECT_EQ(side->faces, 720);
      EXPECT_NEAR(side->tilt, std::atan(eta), 1e-4);  // onto an end: rolling on is no toppling
      EXPECT_NEAR(total(poses), 1, 1e-9);
    }
  }
}

TEST(StablePoses, AnEndThatDoesNotHoldTopplesTheWayItLeans) {
  // Prism 10 x 10 mm, 30 high, its top shifted by 16 mm along x: the mass centre lies 8 mm beyond the middle of the
  // bottom, 3 mm over its edge. Which face a random direction from the mass centre meets is counted; the ends' share
  // goes to the slanted faces: down to +x from the bottom, to -x from the top.
  std::vector<Eigen::Vector3d> points;
  for (const double z : {-0.015, 0.015})
    for (const double x : {-0.005, 0.005})
      for (const double y : {-0.005, 0.005}) points.emplace_back(x + 16.0 / 30 * z, y, z);
  const Eigen::Vector3d slant = Eigen::Vector3d(1, 0, -16.0 / 30).normalized();
  int on_slant = 0, on_flat = 0;
  constexpr int kDirections = 200000;
  Rng rng = Seed{7}.rng();
  for (int k = 0; k < kDirections; ++k) {
    const Eigen::Vector3d d = rng.unit_vector();
    const double to_end = 0.015 / std::abs(d.z()), to_slant = slant.x() * 0.005 / std::abs(slant.dot(d)),
                 to_flat = 0.005 / std::abs(d.y());
    on_flat += to_flat < std::min(to_end, to_slant);
    on_slant += to_flat >= std::min(to_end, to_slant);
  }
  const std::vector<StablePose> poses = stable_poses(points, {0, 0, 0}, {});
  ASSERT_EQ(poses.size(), 4u);
  for (const StablePose& pose : poses) {
    const bool flat = std::abs(pose.down_P.y()) > 0.9;
    EXPECT_NEAR(pose.probability, (flat ? on_flat : on_slant) / 2.0 / kDirections, 0.004);
    EXPECT_NEAR(std::abs(pose.down_P.dot(flat ? Eigen::Vector3d(0, 1, 0) : slant)), 1, 1e-9);
  }
  EXPECT_NEAR(total(poses), 1, 1e-12);
}

TEST(StablePoses, ALoadedDieFallsOnItsHeavySide) {
  // A cube of 30 mm whose mass centre lies 4 mm over one face.
  const std::vector<StablePose> poses = stable_poses(cuboid(0.03, 0.03), {0, 0, -0.011}, {});
  ASSERT_EQ(poses.size(), 6u);
  EXPECT_LT(poses[0].down_P.z(), -0.99);
  EXPECT_NEAR(poses[0].height, 0.004, 1e-12);
  EXPECT_NEAR(poses[0].tilt, std::atan(15.0 / 4), 1e-9);
  EXPECT_NEAR(total(poses), 1, 1e-12);
  for (const StablePose& pose : poses) {
    // Resting: the lowest point is at the floor, the mass centre over the origin at its height.
    double lowest = 1;
    for (const Eigen::Vector3d& p : cuboid(0.03, 0.03)) lowest = std::min(lowest, (pose.X_FP * p).z());
    EXPECT_NEAR(lowest, 0, 1e-12);
    EXPECT_LT((pose.X_FP * Eigen::Vector3d(0, 0, -0.011) - Eigen::Vector3d(0, 0, pose.height)).norm(), 1e-12);
  }
}

TEST(StablePoses, FlatPointsHaveNone) {
  EXPECT_TRUE(stable_poses({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0.5, 0.5, 0}, {}).empty());
}

}  // namespace
}  // namespace binpick

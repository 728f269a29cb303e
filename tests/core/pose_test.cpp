#include "core/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;

Pose random_pose(Rng& rng) {
  return pose_from(rng.rotation().toRotationMatrix(), Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()));
}

TEST(Pose, RollPitchYawOfKnownTurns) {
  // Yaw of 90 degrees carries x to y; roll of 90 degrees carries y to z.
  EXPECT_NEAR(
      (pose_from_xyz_rpy({1, 2, 3}, {0, 0, kPi / 2}) * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 0,
      1e-15);
  EXPECT_NEAR(
      (pose_from_xyz_rpy({0, 0, 0}, {kPi / 2, 0, 0}) * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(0, 0, 1)).norm(), 0,
      1e-15);
}

TEST(Pose, RollPitchYawRoundTrip) {
  for (std::uint64_t k = 0; k < 1000; ++k) {
    Rng rng = Seed{21}.child("rpy", k).rng();
    const Eigen::Matrix3d R = rng.rotation().toRotationMatrix();
    EXPECT_LT(angle_between(pose_from_xyz_rpy({0, 0, 0}, rpy_of(R)).linear(), R), 1e-12) << "item " << k;
  }
}

TEST(Pose, StoredPosesReadBackToTheSameBits) {
  for (std::uint64_t k = 0; k < 1000; ++k) {
    Rng rng = Seed{22}.child("stored", k).rng();
    Eigen::Vector3d rpy(rng.uniform(-kPi, kPi), rng.uniform(-kPi / 2, kPi / 2), rng.uniform(-kPi, kPi));
    if (k % 5 == 0) rpy.y() = k % 2 ? kPi / 2 : -kPi / 2;  // the pole, where roll and yaw are one
    const Pose X = stored_pose(pose_from_xyz_rpy({0.1, 0.2, 0.3}, rpy));
    EXPECT_EQ(stored_pose(X).matrix(), X.matrix()) << "item " << k;
  }
}

TEST(Pose, ExponentialAndLogarithmAreInverse) {
  for (std::uint64_t k = 0; k < 1000; ++k) {
    Rng rng = Seed{23}.child("se3", k).rng();
    const Pose X = random_pose(rng);
    EXPECT_LT((exp_se3(log_se3(X)).matrix() - X.matrix()).cwiseAbs().maxCoeff(), 1e-10) << "item " << k;
  }
  Vector6d tiny;
  tiny << 1e-9, -2e-9, 3e-9, 1e-10, 2e-10, -1e-10;
  EXPECT_LT((log_se3(exp_se3(tiny)) - tiny).norm(), 1e-18);
}

TEST(Pose, ScrewAboutZ) {
  // Turning by pi/2 about z while moving 1 along the tangent ends at (r, r) with r = 2/pi.
  Vector6d twist;
  twist << 1, 0, 0, 0, 0, kPi / 2;
  EXPECT_LT((exp_se3(twist).translation() - Eigen::Vector3d(2 / kPi, 2 / kPi, 0)).norm(), 1e-15);
}

TEST(Pose, AnglesNearZeroAndNearPi) {
  for (const double angle : {0.0, 1e-9, 1e-4, 1.0, kPi - 1e-7, kPi}) {
    const Eigen::Matrix3d R = exp_so3(angle * Eigen::Vector3d(2, -1, 2) / 3);
    EXPECT_NEAR(angle_between(Eigen::Matrix3d::Identity(), R), angle, 1e-12);
  }
}

TEST(Pose, RotationWithZ) {
  for (std::uint64_t k = 0; k < 100; ++k) {
    Rng rng = Seed{24}.child("z", k).rng();
    const Eigen::Vector3d z = rng.unit_vector();
    const Eigen::Matrix3d R = rotation_with_z(3 * z);
    EXPECT_TRUE(is_rigid(pose_from(R, z), 1e-12)) << "item " << k;
    EXPECT_LT((R.col(2) - z).norm(), 1e-12) << "item " << k;
  }
}

TEST(Pose, RigidMeansRigid) {
  Pose X = Pose::Identity();
  EXPECT_TRUE(is_rigid(X));
  X.linear()(0, 0) = 1.001;
  EXPECT_FALSE(is_rigid(X));
  X.linear() = Eigen::Vector3d(1, 1, -1).asDiagonal();  // a mirror
  EXPECT_FALSE(is_rigid(X));
  X = Pose::Identity();
  X.translation().x() = std::nan("");
  EXPECT_FALSE(is_rigid(X));
}

}  // namespace
}  // namespace binpick

#include "core/symmetry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/pose.hpp"
#include "core/random.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;

SymmetrySpec spec_of(const std::string& type, int order = 2, bool flip = false) {
  SymmetrySpec spec;
  spec.type = type;
  spec.order = order;
  spec.flip = flip;
  spec.axis = Eigen::Vector3d(0, 0, 2);  // not of unit length on purpose
  spec.point = Eigen::Vector3d(0.03, -0.02, 0.01);
  return spec;
}

/// Every kind of group, none of whose fixed points is the origin.
std::vector<Symmetry> all_kinds() {
  std::vector<Symmetry> kinds;
  for (const SymmetrySpec& spec :
       {spec_of("none"), spec_of("cyclic", 5), spec_of("dihedral", 3), spec_of("dihedral", 1), spec_of("revolution"),
        spec_of("revolution", 2, true), spec_of("sphere")}) {
    kinds.push_back(make_symmetry(spec));
  }
  return kinds;
}

Pose random_pose(Rng& rng) {
  Pose X = Pose::Identity();
  X.linear() = rng.rotation().toRotationMatrix();
  X.translation() = Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
  return X;
}

/// A random member of the group.
Pose random_member(const Symmetry& symmetry, Rng& rng) {
  const Pose& member = symmetry.finite[rng.below(symmetry.finite.size())];
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  if (symmetry.axis) {
    R = Eigen::AngleAxisd(rng.uniform(0, 2 * kPi), symmetry.axis->direction_P).toRotationMatrix();
    point = symmetry.axis->point_P;
  } else if (symmetry.center_P) {
    R = rng.rotation().toRotationMatrix();
    point = *symmetry.center_P;
  }
  Pose turn = Pose::Identity();
  turn.linear() = R;
  turn.translation() = point - R * point;
  return member * turn;
}

TEST(Symmetry, GroupsHaveTheirOrder) {
  EXPECT_TRUE(make_symmetry(spec_of("none")).trivial());
  EXPECT_EQ(make_symmetry(spec_of("cyclic", 5)).finite.size(), 5u);
  EXPECT_EQ(make_symmetry(spec_of("dihedral", 3)).finite.size(), 6u);
  EXPECT_EQ(make_symmetry(spec_of("revolution")).finite.size(), 1u);
  EXPECT_EQ(make_symmetry(spec_of("revolution", 2, true)).finite.size(), 2u);
  EXPECT_FALSE(make_symmetry(spec_of("revolution")).trivial());
  EXPECT_FALSE(make_symmetry(spec_of("sphere")).trivial());
}

TEST(Symmetry, MembersFixThePointAndIdentityIsFirst) {
  for (const Symmetry& symmetry : all_kinds()) {
    EXPECT_TRUE(symmetry.finite.front().isApprox(Pose::Identity(), 0));
    const Eigen::Vector3d point = spec_of("none").point;
    for (const Pose& S : sampled_group(symmetry, 7)) {
      if (!symmetry.trivial()) {
        EXPECT_LT((S * point - point).norm(), 1e-15);
      }
      EXPECT_NEAR(S.linear().determinant(), 1, 1e-12);
    }
  }
}

TEST(Symmetry, FiniteGroupsAreClosed) {
  for (const SymmetrySpec& spec : {spec_of("cyclic", 5), spec_of("dihedral", 3), spec_of("dihedral", 4)}) {
    const std::vector<Pose> group = make_symmetry(spec).finite;
    for (const Pose& A : group) {
      for (const Pose& B : group) {
        const Pose product = A * B;
        const auto same = [&](const Pose& C) { return C.isApprox(product, 1e-12); };
        EXPECT_EQ(std::count_if(group.begin(), group.end(), same), 1);
      }
    }
  }
}

TEST(Symmetry, DihedralOfTwoIsThatOfABox) {
  SymmetrySpec spec = spec_of("dihedral", 2);
  spec.point.setZero();
  const std::vector<Pose> group = make_symmetry(spec).finite;
  const Eigen::Vector3d corner(1, 2, 3);
  ASSERT_EQ(group.size(), 4u);
  EXPECT_EQ((group[1] * corner).eval(), Eigen::Vector3d(-1, -2, 3));  // about z
  EXPECT_EQ((group[2] * corner).eval(), Eigen::Vector3d(1, -2, -3));  // about x
  EXPECT_EQ((group[3] * corner).eval(), Eigen::Vector3d(-1, 2, -3));  // about y
}

TEST(Symmetry, NearestEquivalentUndoesAnyMember) {
  const Seed seed{20261124};
  for (std::size_t kind = 0; kind < all_kinds().size(); ++kind) {
    const Symmetry symmetry = all_kinds()[kind];
    for (std::uint64_t i = 0; i < 200; ++i) {
      Rng rng = seed.child("undo", kind).rng().at(i);
      const Pose X_ref = random_pose(rng);
      const Pose twin = nearest_equivalent(X_ref * random_member(symmetry, rng), X_ref, symmetry);
      EXPECT_LT((twin.matrix() - X_ref.matrix()).norm(), 1e-7) << "kind " << kind << ", item " << i;
    }
  }
}

// No member of the densely sampled group may come nearer than the closed form, and the result must be a member itself.
TEST(Symmetry, NearestEquivalentBeatsEverySample) {
  const Seed seed{20261124};
  for (std::size_t kind = 0; kind < all_kinds().size(); ++kind) {
    const Symmetry symmetry = all_kinds()[kind];
    const std::vector<Pose> group = sampled_group(symmetry, 61);
    for (std::uint64_t i = 0; i < 50; ++i) {
      Rng rng = seed.child("beats", kind).rng().at(i);
      const Pose X_ref = random_pose(rng), X = random_pose(rng);
      const Pose twin = nearest_equivalent(X, X_ref, symmetry);
      const double angle = Eigen::AngleAxisd(X_ref.linear().transpose() * twin.linear()).angle();
      for (const Pose& S : group) {
        const double other = Eigen::AngleAxisd(X_ref.linear().transpose() * (X * S).linear()).angle();
        EXPECT_LE(angle, other + 1e-7) << "kind " << kind << ", item " << i;
      }
      const Pose back = nearest_equivalent(X, twin, symmetry);
      EXPECT_LT((back.matrix() - twin.matrix()).norm(), 1e-7) << "kind " << kind << ", item " << i;
    }
  }
}

TEST(Symmetry, ATiltedRingKeepsItsTilt) {
  SymmetrySpec spec = spec_of("revolution", 2, true);
  spec.point.setZero();
  const Pose X_ref = Pose::Identity();
  const Pose X(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) *
               Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));
  const Pose twin = nearest_equivalent(X, X_ref, make_symmetry(spec));
  EXPECT_NEAR(Eigen::AngleAxisd(twin.linear()).angle(), 0.3, 1e-12);
}

TEST(Symmetry, OppositeAxesWithoutFlipStayPut) {
  SymmetrySpec spec = spec_of("revolution");
  spec.point.setZero();
  const Pose X(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  const Pose twin = nearest_equivalent(X, Pose::Identity(), make_symmetry(spec));
  EXPECT_NEAR(Eigen::AngleAxisd(twin.linear()).angle(), kPi, 1e-9);
}

TEST(Symmetry, SampledGroupOfASphereIsSpread) {
  const std::vector<Pose> group = sampled_group(make_symmetry(spec_of("sphere")), 20);
  ASSERT_EQ(group.size(), 400u);
  EXPECT_TRUE(group.front().isApprox(Pose::Identity(), 0));
  Rng rng = Seed{7}.child("spread").rng();
  for (int i = 0; i < 100; ++i) {  // 400 balls of 40 degrees would cover SO(3) more than five times over
    const Eigen::Matrix3d R = rng.rotation().toRotationMatrix();
    double nearest = kPi;
    for (const Pose& S : group) nearest = std::min(nearest, Eigen::AngleAxisd(R.transpose() * S.linear()).angle());
    EXPECT_LT(nearest, 40 * kPi / 180) << "item " << i;
  }
}

TEST(Symmetry, BadSpecsAreRefusedByName) {
  const auto message = [](const SymmetrySpec& spec) {
    try {
      make_symmetry(spec);
    } catch (const SpecError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  SymmetrySpec spec = spec_of("cyclic");
  spec.axis.setZero();
  EXPECT_EQ(message(spec), "symmetry.axis: must not be zero");
  EXPECT_EQ(message(spec_of("cyclic", 1)).rfind("symmetry.order", 0), 0u);
  EXPECT_EQ(message(spec_of("revolve")).rfind("symmetry.type", 0), 0u);
  spec = spec_of("dihedral");
  spec.perpendicular = Eigen::Vector3d(0, 1, 1);
  EXPECT_EQ(message(spec).rfind("symmetry.perpendicular", 0), 0u);
}

}  // namespace
}  // namespace binpick

// True solids in each other, against depths known on paper.
#include <gtest/gtest.h>

#include <numbers>

#include "core/random.hpp"
#include "example_parts.hpp"
#include "sim/bin.hpp"
#include "sim/penetration.hpp"

namespace binpick {
namespace {

Pose shift(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

double both_ways(const SolidProbe& a, const SolidProbe& b, const Pose& X_AB) {
  return std::max(a.deepest_of(b, X_AB), b.deepest_of(a, X_AB.inverse()));
}

TEST(Penetration, FaceOnFace) {
  const SolidProbe box(example::box({0.06, 0.04, 0.02}).envelope_P, 2e-3);
  EXPECT_NEAR(both_ways(box, box, shift(0.01, 0.007, 0.02 - 0.7e-3)), 0.7e-3, 1e-9);
  EXPECT_EQ(both_ways(box, box, shift(0.01, 0.007, 0.02 + 1e-6)), 0);
  EXPECT_EQ(both_ways(box, box, shift(1, 0, 0)), 0);
}

TEST(Penetration, ACornerInAFaceAtAnyAttitude) {
  const SolidProbe slab(mesh_of(Primitive::box({0.2, 0.2, 0.05}, shift(0, 0, -0.025))), 5e-3);
  const Part part = example::box({0.03, 0.03, 0.03});
  const SolidProbe cube(part.envelope_P, 2e-3);
  for (std::uint64_t k = 0; k < 20; ++k) {
    Rng rng = Seed{3}.child("attitude", k).rng();
    Pose X_SC(rng.rotation());
    double lowest = 1;
    for (const Eigen::Vector3d& v : part.envelope_P.vertices) lowest = std::min(lowest, (X_SC * v).z());
    X_SC.pretranslate(Eigen::Vector3d(0, 0, -lowest - 0.4e-3));
    EXPECT_NEAR(both_ways(slab, cube, X_SC), 0.4e-3, 1e-9) << "attitude " << k;
  }
}

TEST(Penetration, ARingThroughARingHasAirInItsHole) {
  // The chain: each passes through the other's hole, 70 mm wide, without touching.
  const SolidProbe ring(example::ring().envelope_P, 2e-3);
  const Eigen::AngleAxisd upright(std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  EXPECT_EQ(both_ways(ring, ring, shift(0.0425, 0, 0) * Pose(upright)), 0);
  // Coplanar: the convex hull of one reaches far into the other's hole.
  EXPECT_NEAR(both_ways(ring, ring, shift(0.01, 0, 0.016 - 0.5e-3)), 0.5e-3, 1e-9);
}

TEST(Penetration, InTheBinEveryBodyAndEveryPairThatEnters) {
  const BinSpec bin;
  World world{PhysicsConfig{}};
  const Part part = example::box({0.06, 0.04, 0.02});
  const CollisionShape shape = collision_shape(part);
  const SolidProbe probe(part.envelope_P, 2e-3);
  const Pose X_WB = shift(0.5, 0.1, 0.02);
  const std::vector<BodyId> bodies = {world.add_free(part, shape, X_WB * shift(0, 0, -0.3e-3)),
                                      world.add_free(part, shape, X_WB * shift(0, 0, 0.02 - 0.5e-3)),
                                      world.add_free(part, shape, X_WB * shift(-0.15, 0, 0.1))};
  const std::vector<const SolidProbe*> probes(3, &probe);
  const std::vector<double> depths = penetrations(world, bodies, probes, bin, X_WB);
  ASSERT_EQ(depths.size(), 2u);
  EXPECT_NEAR(depths[0], 0.2e-3, 1e-9);  // of the pair
  EXPECT_NEAR(depths[1], 0.3e-3, 1e-9);  // of the lower one in the floor
}

}  // namespace
}  // namespace binpick

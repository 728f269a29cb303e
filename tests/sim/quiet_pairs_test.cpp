// Pairs at rest keep their contact points; what moves is searched, and nothing falls through a floor that was quiet.
#include "sim/quiet_pairs.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace binpick {
namespace {

constexpr double kStep = 1e-3;

/// A slab and a cube of 40 mm on it.
struct CubeOnSlab {
  btDefaultCollisionConfiguration configuration;
  QuietPairs pairs{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&pairs, &broadphase, &solver, &configuration};
  btBoxShape slab_shape{btVector3(0.2, 0.2, 0.05)}, cube_shape{btVector3(0.02, 0.02, 0.02)};
  std::unique_ptr<btRigidBody> slab, cube;

  explicit CubeOnSlab(double tolerance) {
    gContactBreakingThreshold = 0.002;
    pairs.setDispatcherFlags(0);
    pairs.set_tolerance(tolerance);
    world.setGravity({0, 0, -9.81});
    slab = add(slab_shape, 0, {0, 0, -0.05}, 0);
    cube = add(cube_shape, 0.2, {0, 0, 0.021}, 1);
  }
  ~CubeOnSlab() {
    world.removeRigidBody(cube.get());
    world.removeRigidBody(slab.get());
  }
  std::unique_ptr<btRigidBody> add(btConvexInternalShape& shape, double mass, const btVector3& at, int index) {
    if (shape.isPolyhedral()) shape.setMargin(2e-4);  // a ball's margin is its radius
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    auto body = std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia);
    body->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    body->setUserIndex(index);
    body->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(body.get());
    return body;
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) world.stepSimulation(kStep, 0);
  }
  int points() const {
    int count = 0;
    for (int m = 0; m < pairs.getNumManifolds(); ++m)
      count += const_cast<QuietPairs&>(pairs).getManifoldByIndexInternal(m)->getNumContacts();
    return count;
  }
  double height() const { return cube->getWorldTransform().getOrigin().z(); }
};

TEST(QuietPairs, ACubeStandsOnFourPointsAsIfSearchedInEveryStep) {
  CubeOnSlab quiet(5e-5), searched(0);
  quiet.run(1000);
  searched.run(1000);
  EXPECT_EQ(quiet.points(), 4);
  EXPECT_EQ(searched.points(), 4);
  EXPECT_NEAR(quiet.height(), searched.height(), 2e-5);
  EXPECT_LT(quiet.cube->getLinearVelocity().length(), 1e-4);
  EXPECT_GT(quiet.pairs.searched(), 8);
  EXPECT_LT(quiet.pairs.searched(), searched.pairs.searched() / 3);
}

TEST(QuietPairs, APushedCubeIsSearchedAgainAndDoesNotSinkIn) {
  CubeOnSlab bench(5e-5);
  bench.run(500);
  const long before = bench.pairs.searched();
  bench.cube->setLinearVelocity({0.5, 0, 0});
  bench.run(100);
  EXPECT_GT(bench.pairs.searched(), before + 10);  // 20 mm of way and more, 0.05 mm a search
  EXPECT_GT(bench.cube->getWorldTransform().getOrigin().x(), 0.01);
  EXPECT_NEAR(bench.height(), 0.02, 1e-4);
}

TEST(QuietPairs, ABallAtRestIsSearchedInEveryStep) {
  CubeOnSlab bench(5e-5);
  btCapsuleShape shape(0.02, 0);
  const auto ball = bench.add(shape, 0.2, {0.1, 0, 0.02}, 2);
  bench.run(500);
  const long before = bench.pairs.searched();
  bench.run(100);
  EXPECT_EQ(bench.pairs.searched(), before + 100);  // the ball's pair with the slab; the cube's is carried
  bench.world.removeRigidBody(ball.get());
}

TEST(QuietPairs, ASlabThatIsTakenAwayHoldsNothing) {
  CubeOnSlab bench(5e-5);
  bench.run(500);
  bench.slab->setWorldTransform(btTransform(btQuaternion::getIdentity(), {0, 0, -1}));
  bench.world.updateSingleAabb(bench.slab.get());
  bench.run(100);
  EXPECT_LT(bench.height(), 0.02 - 0.5 * 9.81 * 0.09 * 0.09);
}

}  // namespace
}  // namespace binpick

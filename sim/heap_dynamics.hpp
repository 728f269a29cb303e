// Private to sim: Bullet's world with what a heap needs between collision detection and the solver.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <map>
#include <utility>

namespace binpick {

/// Bullet gives every contact point three rows of rolling and spinning friction: as many as its normal and sliding
/// friction take, and two bodies that touch in eight points do not roll anyway. Here only the point of a pair of bodies
/// that bears most has them, for the load of all points, so that the lever arm is the stated one and the solver has
/// half the rows: it converges sooner, and heaps creep less.
class HeapDynamics : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

 protected:
  void solveConstraints(btContactSolverInfo& info) override;

 private:
  struct Load {
    btManifoldPoint* most = nullptr;
    const btPersistentManifold* manifold = nullptr;
    btScalar total = 0;  ///< N s, of all points in the last step
  };
  void gather_rolling_friction();
  void scale_impulses(btScalar factor);

  std::map<std::pair<int, int>, Load> loads_;  ///< by user index of the bodies
  btScalar last_step_ = 0;                     ///< s
};

}  // namespace binpick

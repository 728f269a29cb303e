// Private to sim: Bullet's solver, with friction that remembers.
#pragma once

#include <btBulletDynamicsCommon.h>

namespace binpick {

/// Bullet starts every contact's normal impulse from the last step's, but its friction from nothing: a heap that hangs
/// together by friction is solved anew in each step, is never quite done, and creeps. Here friction starts from the
/// last step's as well, as one vector in the contact plane, since the rows' directions follow the sliding velocity.
class HeapSolver : public btSequentialImpulseConstraintSolver {
 protected:
  void convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) override;
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count, btTypedConstraint** constraints,
                                int constraint_count, const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int count,
                                         const btContactSolverInfo& info) override;

 private:
  void add_impulse(btSolverConstraint& row, btScalar impulse);
};

}  // namespace binpick

#include "sim/heap_dynamics.hpp"

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>

namespace binpick {

void HeapDynamics::solveConstraints(btContactSolverInfo& info) {
  if (last_step_ > 0 && last_step_ != info.m_timeStep) scale_impulses(info.m_timeStep / last_step_);
  last_step_ = info.m_timeStep;
  gather_rolling_friction();
  btDiscreteDynamicsWorld::solveConstraints(info);
}

/// The solver starts from the last step's impulses, and a load's impulse is as long as the step.
void HeapDynamics::scale_impulses(btScalar factor) {
  for (int m = 0; m < getDispatcher()->getNumManifolds(); ++m) {
    btPersistentManifold& manifold = *getDispatcher()->getManifoldByIndexInternal(m);
    for (int c = 0; c < manifold.getNumContacts(); ++c) {
      btManifoldPoint& point = manifold.getContactPoint(c);
      point.m_appliedImpulse *= factor;
      point.m_appliedImpulseLateral1 *= factor;
      point.m_appliedImpulseLateral2 *= factor;
    }
  }
}

void HeapDynamics::gather_rolling_friction() {
  loads_.clear();
  for (int m = 0; m < getDispatcher()->getNumManifolds(); ++m) {
    btPersistentManifold& manifold = *getDispatcher()->getManifoldByIndexInternal(m);
    if (manifold.getNumContacts() == 0) continue;
    if (!manifold.getBody0()->isActive() && !manifold.getBody1()->isActive()) continue;
    Load& load = loads_[{manifold.getBody0()->getUserIndex(), manifold.getBody1()->getUserIndex()}];
    for (int c = 0; c < manifold.getNumContacts(); ++c) {
      btManifoldPoint& point = manifold.getContactPoint(c);
      point.m_combinedRollingFriction = point.m_combinedSpinningFriction = 0;
      load.total += point.getAppliedImpulse();
      if (load.most && point.getAppliedImpulse() <= load.most->getAppliedImpulse()) continue;
      load.most = &point;
      load.manifold = &manifold;
    }
  }
  for (const auto& [pair, load] : loads_) {
    const btCollisionObject *a = load.manifold->getBody0(), *b = load.manifold->getBody1();
    const btScalar own = load.most->getAppliedImpulse();
    const btScalar share = own > 0 ? load.total / own : 1;  // at most the number of points
    load.most->m_combinedRollingFriction = share * btManifoldResult::calculateCombinedRollingFriction(a, b);
    load.most->m_combinedSpinningFriction = share * btManifoldResult::calculateCombinedSpinningFriction(a, b);
  }
}

}  // namespace binpick

#include "sim/heap_solver.hpp"

namespace binpick {
namespace {

/// Two axes of the contact plane that hang on the normal only. Bullet carries the two lateral impulses of a point over
/// when it renews the point, but not the directions of its rows.
struct PlaneAxes {
  explicit PlaneAxes(const btManifoldPoint& point) { btPlaneSpace1(point.m_normalWorldOnB, u, v); }
  btVector3 u, v;
};

/// Along which a row pushes the first body; Bullet leaves it zero where that body is fixed.
btVector3 direction_of(const btSolverConstraint& row, const btSolverBody& first) {
  return first.m_originalBody ? row.m_contactNormal1 : -row.m_contactNormal2;
}

}  // namespace

void HeapSolver::add_impulse(btSolverConstraint& row, btScalar impulse) {
  btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
  row.m_appliedImpulse += impulse;
  a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, impulse);
  b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, impulse);
}

void HeapSolver::convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) {
  btSequentialImpulseConstraintSolver::convertContacts(manifolds, count, info);
  for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
    const btSolverConstraint& contact = m_tmpSolverContactConstraintPool[i];
    const auto& point = *static_cast<const btManifoldPoint*>(contact.m_originalContactPoint);
    if (point.m_appliedImpulseLateral1 == 0 && point.m_appliedImpulseLateral2 == 0) continue;
    const PlaneAxes axes(point);
    const btVector3 impulse =
        info.m_warmstartingFactor * (axes.u * point.m_appliedImpulseLateral1 + axes.v * point.m_appliedImpulseLateral2);
    const btSolverBody& first = m_tmpSolverBodyPool[contact.m_solverBodyIdA];
    for (int k = 0; k < 2; ++k) {
      btSolverConstraint& row = m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex + k];
      add_impulse(row, impulse.dot(direction_of(row, first)));
    }
  }
}

/// Bullet limits the friction of a point by what presses on it, but does not look at points that nothing presses on:
/// there it would stay as it was.
btScalar HeapSolver::solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                          btPersistentManifold** manifolds, int manifold_count,
                                          btTypedConstraint** constraints, int constraint_count,
                                          const btContactSolverInfo& info, btIDebugDraw* drawer) {
  const btScalar residual = btSequentialImpulseConstraintSolver::solveSingleIteration(
      iteration, bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, drawer);
  for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
    const btSolverConstraint& contact = m_tmpSolverContactConstraintPool[i];
    if (contact.m_appliedImpulse > 0) continue;
    for (int k = 0; k < 2; ++k) {
      btSolverConstraint& row = m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex + k];
      if (row.m_appliedImpulse != 0) add_impulse(row, -row.m_appliedImpulse);
    }
  }
  return residual;
}

/// Bullet writes the rows' impulses to the points: they are turned into the plane's axes before.
btScalar HeapSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int count,
                                                   const btContactSolverInfo& info) {
  for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
    const btSolverConstraint& contact = m_tmpSolverContactConstraintPool[i];
    btSolverConstraint* row = &m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex];
    const btSolverBody& first = m_tmpSolverBodyPool[contact.m_solverBodyIdA];
    const btVector3 impulse =
        direction_of(row[0], first) * row[0].m_appliedImpulse + direction_of(row[1], first) * row[1].m_appliedImpulse;
    const PlaneAxes axes(*static_cast<const btManifoldPoint*>(contact.m_originalContactPoint));
    row[0].m_appliedImpulse = impulse.dot(axes.u);
    row[1].m_appliedImpulse = impulse.dot(axes.v);
  }
  return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyFinish(bodies, count, info);
}

}  // namespace binpick

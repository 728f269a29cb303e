#include "sim/quiet_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

constexpr int kSearches = 8;  // of a pair at rest: a face takes four points, and not each search finds a new one

const btCollisionObject& object(const btBroadphaseProxy* proxy) {
  return *static_cast<const btCollisionObject*>(proxy->m_clientObject);
}

btScalar radius_of(const btCollisionObject& body) {
  btVector3 centre;
  btScalar radius = 0;
  body.getCollisionShape()->getBoundingSphere(centre, radius);
  return centre.length() + radius;
}

/// Has faces only: a contact of a ball, a capsule or a cylinder wanders over its surface as it rolls, and is not
/// carried.
bool faceted(const btCollisionShape& shape) {
  if (!shape.isCompound()) return shape.isPolyhedral();
  const auto& pieces = static_cast<const btCompoundShape&>(shape);
  for (int k = 0; k < pieces.getNumChildShapes(); ++k)
    if (!faceted(*pieces.getChildShape(k))) return false;
  return true;
}

/// Bound on the motion of any point of a body of this radius, m.
btScalar motion(const btTransform& a, const btTransform& b, btScalar radius) {
  btScalar squares = 0;  // |A - B|^2 in Frobenius norm is 8 sin^2(angle / 2)
  for (int row = 0; row < 3; ++row) squares += (a.getBasis()[row] - b.getBasis()[row]).length2();
  return a.getOrigin().distance(b.getOrigin()) + std::sqrt(squares / 2) * radius;
}

}  // namespace

QuietPairs::QuietPairs(btCollisionConfiguration* configuration) : btCollisionDispatcher(configuration) {
  setNearCallback(process);
}

void QuietPairs::process(btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
  auto& self = static_cast<QuietPairs&>(dispatcher);
  if (!self.needsCollision(&object(pair.m_pProxy0), &object(pair.m_pProxy1))) return;
  if (self.tolerance_ > 0 && self.quiet(pair)) {
    self.carry_points(pair);
    return;
  }
  ++self.searched_;
  defaultNearCallback(pair, dispatcher, info);
}

bool QuietPairs::quiet(const btBroadphasePair& pair) {
  const btCollisionObject &a = object(pair.m_pProxy0), &b = object(pair.m_pProxy1);
  const long long key = (static_cast<long long>(a.getUserIndex()) << 32) + b.getUserIndex();
  const btTransform X_01 = a.getWorldTransform().inverseTimes(b.getWorldTransform());
  const auto [entry, fresh] = seen_.try_emplace(key);
  Seen& seen = entry->second;
  // Without an algorithm the pair has just come together again.
  if (fresh) {
    seen.radius = std::min(radius_of(a), radius_of(b));
    seen.round = !faceted(*a.getCollisionShape()) || !faceted(*b.getCollisionShape());
  }
  if (seen.round) return false;
  if (fresh || !pair.m_algorithm || motion(seen.X_01, X_01, seen.radius) > tolerance_)
    seen.X_01 = X_01, seen.searches = 0;
  return ++seen.searches > kSearches;
}

void QuietPairs::carry_points(const btBroadphasePair& pair) {
  manifolds_.resizeNoInitialize(0);
  pair.m_algorithm->getAllContactManifolds(manifolds_);
  for (int m = 0; m < manifolds_.size(); ++m) {
    btPersistentManifold& manifold = *manifolds_[m];
    manifold.refreshContactPoints(manifold.getBody0()->getWorldTransform(), manifold.getBody1()->getWorldTransform());
  }
}

}  // namespace binpick

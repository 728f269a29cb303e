// Reading and steering single bodies of the world.
#include <algorithm>
#include <map>

#include "core/check.hpp"
#include "sim/world_impl.hpp"

namespace binpick {
namespace {

struct DeepestContact : btCollisionWorld::ContactResultCallback {
  double depth = 0;
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    depth = std::max(depth, -point.getDistance());
    return 0;
  }
};

constexpr double kContactMargin = 1e-6;  // m

/// Does the box reach one of the body's pieces? A tool between the walls of a bin lies in the bin's own box all the
/// time.
bool reaches_a_child(const btCompoundShape& shape, const btTransform& X_WM, const btVector3& low,
                     const btVector3& high) {
  for (int k = 0; k < shape.getNumChildShapes(); ++k) {
    btVector3 child_low, child_high;
    shape.getChildShape(k)->getAabb(X_WM * shape.getChildTransform(k), child_low, child_high);
    bool apart = false;
    for (int i = 0; i < 3; ++i)
      apart |= low[i] > child_high[i] + kContactMargin || child_low[i] > high[i] + kContactMargin;
    if (!apart) return true;
  }
  return false;
}

}  // namespace

void World::move_to(BodyId body, const Pose& X_WO) {
  Impl::Body& moved = impl_->at(body);
  BP_CHECK(moved.kind == BodyKind::kMoved, "body " << body << " is not a moved one");
  moved.X_WO_target = X_WO;
  moved.moving = true;
}

void World::set_collides(BodyId a, BodyId b, bool collides) {
  const std::pair<int, int> pair{std::min(a, b), std::max(a, b)};
  const bool changed = collides ? impl_->filter.ignored.erase(pair) > 0 : impl_->filter.ignored.insert(pair).second;
  if (!changed) return;
  impl_->manifolds_known = false;
  // Existing contacts of the pair go away, and the broad phase finds it anew.
  for (const BodyId id : {a, b}) {
    btBroadphaseProxy* proxy = impl_->at(id).rigid->getBroadphaseProxy();
    if (proxy)
      impl_->broadphase->getOverlappingPairCache()->removeOverlappingPairsContainingProxy(proxy,
                                                                                          impl_->dispatcher.get());
  }
  for (const BodyId id : {a, b})
    if (impl_->at(id).present) set_present(id, false), set_present(id, true);
}

void World::set_present(BodyId body, bool present) {
  Impl::Body& b = impl_->at(body);
  if (b.present == present) return;
  impl_->thaw(b);
  b.present = present;
  if (present) return impl_->join_world(b);
  impl_->world->removeRigidBody(b.rigid.get());
  impl_->manifolds_known = false;
  if (impl_->observer) impl_->observer->left(b);
}

void World::teleport(BodyId body, const Pose& X_WO) {
  Impl::Body& b = impl_->at(body);
  const btTransform X_WM = to_bullet(Pose(X_WO * b.X_OM));
  impl_->thaw(b);
  b.X_WO_target = X_WO;
  b.moving = false;
  b.rigid->setWorldTransform(X_WM);
  b.rigid->setInterpolationWorldTransform(X_WM);
  b.rigid->clearForces();
  set_velocity(body, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  if (b.present) impl_->world->updateSingleAabb(b.rigid.get());
}

void World::set_velocity(BodyId body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  btRigidBody& rigid = *impl_->at(body).rigid;
  rigid.setLinearVelocity(to_bullet(linear));
  rigid.setAngularVelocity(to_bullet(angular));
  rigid.setInterpolationLinearVelocity(to_bullet(linear));
  rigid.setInterpolationAngularVelocity(to_bullet(angular));
}

void World::set_damping(double linear, double angular) {
  for (Impl::Body& body : impl_->bodies)
    if (body.kind == BodyKind::kFree) body.rigid->setDamping(linear, angular);
}

void World::put_to_sleep(BodyId body) {
  set_velocity(body, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  impl_->at(body).rigid->forceActivationState(ISLAND_SLEEPING);
}

double World::time() const { return impl_->time; }
int World::body_count() const { return static_cast<int>(impl_->bodies.size()); }
World::BodyKind World::kind(BodyId body) const { return impl_->at(body).kind; }
bool World::present(BodyId body) const { return impl_->at(body).present; }
double World::bounding_radius(BodyId body) const { return impl_->at(body).geometry->radius; }

Pose World::pose(BodyId body) const {
  const Impl::Body& b = impl_->at(body);
  return from_bullet(b.rigid->getWorldTransform()) * b.X_OM.inverse();
}

Eigen::Vector3d World::mass_center(BodyId body) const {
  return from_bullet(impl_->at(body).rigid->getWorldTransform().getOrigin());
}

Eigen::Vector3d World::velocity(BodyId body) const { return from_bullet(impl_->at(body).rigid->getLinearVelocity()); }

Eigen::Vector3d World::angular_velocity(BodyId body) const {
  return from_bullet(impl_->at(body).rigid->getAngularVelocity());
}

void World::wake(BodyId body) {
  impl_->thaw(impl_->at(body));
  impl_->at(body).rigid->activate(true);
}
void World::set_may_sleep(BodyId body, bool may) {
  impl_->thaw(impl_->at(body));
  impl_->at(body).rigid->forceActivationState(may ? ACTIVE_TAG : DISABLE_DEACTIVATION);
  impl_->at(body).rigid->setDeactivationTime(0);
}

double World::kinetic_energy(BodyId body) const {
  const btRigidBody& rigid = *impl_->at(body).rigid;
  if (rigid.getInvMass() == 0) return 0;
  const btVector3 w_M = rigid.getWorldTransform().getBasis().transpose() * rigid.getAngularVelocity();
  return (rigid.getLinearVelocity().length2() / rigid.getInvMass() + (w_M * w_M).dot(rigid.getLocalInertia())) / 2;
}

bool World::awake(BodyId body) const { return impl_->at(body).rigid->isActive(); }

double World::deepest_contact() const {
  double deepest = 0;
  for (int m = 0; m < impl_->dispatcher->getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *impl_->dispatcher->getManifoldByIndexInternal(m);
    for (int c = 0; c < manifold.getNumContacts(); ++c)
      deepest = std::max(deepest, -manifold.getContactPoint(c).getDistance());
  }
  return deepest;
}

double World::gravity() const { return impl_->config.gravity; }

const std::vector<const btPersistentManifold*>& World::Impl::manifolds_of(BodyId body) {
  if (!manifolds_known) {
    manifolds.resize(bodies.size());
    for (auto& list : manifolds) list.clear();
    for (int m = 0; m < dispatcher->getNumManifolds(); ++m) {
      const btPersistentManifold* manifold = dispatcher->getManifoldByIndexInternal(m);
      if (manifold->getNumContacts() == 0) continue;
      for (const btCollisionObject* object : {manifold->getBody0(), manifold->getBody1()})
        manifolds[static_cast<std::size_t>(object->getUserIndex())].push_back(manifold);
    }
    manifolds_known = true;
  }
  return manifolds[static_cast<std::size_t>(body)];
}

std::vector<World::BodyContact> World::contacts(BodyId body) const {
  std::map<BodyId, BodyContact> by_other;
  impl_->at(body);  // is there one?
  for (const btPersistentManifold* manifold : impl_->manifolds_of(body)) {
    const int a = manifold->getBody0()->getUserIndex(), b = manifold->getBody1()->getUserIndex();
    const BodyId other = a == body ? b : a;
    BodyContact& contact = by_other.try_emplace(other, BodyContact{other, 0, 0}).first->second;
    for (int c = 0; c < manifold->getNumContacts(); ++c) {
      const btManifoldPoint& point = manifold->getContactPoint(c);
      contact.depth = std::max(contact.depth, -point.getDistance());
      if (impl_->last_step > 0) contact.force += point.getAppliedImpulse() / impl_->last_step;
    }
  }
  std::vector<BodyContact> result;
  for (const auto& [other, contact] : by_other) result.push_back(contact);
  return result;
}

double World::overlap(BodyId a, BodyId b) {
  btRigidBody &first = *impl_->at(a).rigid, &second = *impl_->at(b).rigid;
  btVector3 min_a, max_a, min_b, max_b;
  first.getAabb(min_a, max_a);
  second.getAabb(min_b, max_b);
  for (int i = 0; i < 3; ++i)
    if (min_a[i] > max_b[i] || min_b[i] > max_a[i]) return 0;
  if (!reaches_a_child(*impl_->at(b).geometry->compound, second.getWorldTransform(), min_a, max_a)) return 0;
  DeepestContact callback;
  callback.m_closestDistanceThreshold = kContactMargin;  // above 0: the test is made although both sleep
  impl_->world->contactPairTest(&first, &second, callback);
  return callback.depth;
}

}  // namespace binpick

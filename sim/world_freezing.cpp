// Frozen bodies: parts that sleep while the arm works. Bullet keeps a whole island awake with the part that is held,
// and its islands follow overlapping boxes: most of a heap. Everything else as a wall for good would be wrong as well:
// a part hooked on a wall is torn at with kilonewtons. So a frozen part is fixed only until it is loaded or loses what
// it lay on.
#include <algorithm>
#include <cmath>

#include "sim/world_impl.hpp"

namespace binpick {
namespace {

constexpr double kHeavyWeights = 10;  // of load: whatever hangs together with the loaded part wakes with it
constexpr double kNearRadii = 2;      // of a part that the tool touches: parts whose centres lie within wake with it

constexpr double kStillTime = 0.2;  // s below Bullet's sleeping speeds

/// Asleep, or still for long enough: Bullet itself waits for the whole island. What a cup holds never is.
bool is_still(const btRigidBody& body) {
  if (!body.isActive()) return true;
  return body.getActivationState() != DISABLE_DEACTIVATION && body.getDeactivationTime() > kStillTime;
}

double force_of(const btPersistentManifold& manifold, double dt) {
  double impulse = 0;
  for (int c = 0; c < manifold.getNumContacts(); ++c) impulse += manifold.getContactPoint(c).getAppliedImpulse();
  return dt > 0 ? impulse / dt : 0;
}

}  // namespace

double World::Impl::motion_of(const Body& body, const btTransform& X_since) const {
  const btTransform& X_now = body.rigid->getWorldTransform();
  const double shift = X_now.getOrigin().distance(X_since.getOrigin());
  // |R - R0| in Frobenius norm is sqrt(8) sin(angle / 2): no arc function for a small turn.
  double squares = 0;
  for (int row = 0; row < 3; ++row) squares += (X_now.getBasis()[row] - X_since.getBasis()[row]).length2();
  return std::max(shift, std::sqrt(squares / 2) * body.geometry->radius);
}

void World::Impl::freeze(const std::vector<BodyId>& ids) {
  for (const BodyId id : ids) {
    Body& body = at(id);
    body.frozen = true;
    body.mass = 1 / body.rigid->getInvMass();
    body.inertia_M = body.rigid->getLocalInertia();
    body.X_rest = body.rigid->getWorldTransform();
    body.supports.clear();
    body.rigid->setLinearVelocity({0, 0, 0});
    body.rigid->setAngularVelocity({0, 0, 0});
    body.rigid->setMassProps(0, {0, 0, 0});
    body.rigid->updateInertiaTensor();
    body.rigid->forceActivationState(ISLAND_SLEEPING);
  }
  for (int m = 0; m < dispatcher->getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(m);
    if (manifold.getNumContacts() == 0) continue;
    const BodyId a = manifold.getBody0()->getUserIndex(), b = manifold.getBody1()->getUserIndex();
    const double force = force_of(manifold, last_step);
    if (std::binary_search(ids.begin(), ids.end(), a)) note_support(a, b, force);
    if (std::binary_search(ids.begin(), ids.end(), b)) note_support(b, a, force);
  }
}

void World::Impl::note_support(BodyId id, BodyId other, double force) {
  if (at(other).kind == BodyKind::kFixed) return;
  std::vector<Support>& supports = at(id).supports;
  const auto same = std::find_if(supports.begin(), supports.end(), [&](const Support& s) { return s.other == other; });
  if (same == supports.end())
    supports.push_back({other, force, at(other).rigid->getWorldTransform()});
  else
    same->force += force;
}

/// Free again, but asleep.
void World::Impl::thaw(Body& body) {
  if (!body.frozen) return;
  body.frozen = false;
  body.rigid->setMassProps(body.mass, body.inertia_M);
  body.rigid->updateInertiaTensor();
  body.rigid->setGravity(world->getGravity());
  body.rigid->forceActivationState(ISLAND_SLEEPING);
}

void World::Impl::rouse(Body& body) {
  if (!body.frozen) return;
  thaw(body);
  body.rigid->activate(true);
}

/// Awake, with what it touches and what lies near it.
void World::Impl::thaw_near(BodyId id) {
  const Body& centre = at(id);
  const double reach = kNearRadii * centre.geometry->radius;
  const btVector3 p_WM = centre.rigid->getWorldTransform().getOrigin();
  for (BodyId other = 0; other < static_cast<BodyId>(bodies.size()); ++other) {
    Body& body = at(other);
    if (!body.frozen) continue;
    const bool touched = std::any_of(centre.supports.begin(), centre.supports.end(),
                                     [&](const Support& support) { return support.other == other; });
    if (!touched && body.rigid->getWorldTransform().getOrigin().distance(p_WM) > reach) continue;
    rouse(body);
  }
}

/// Awake, with what it touches, and what that touches, to the last.
void World::Impl::thaw_group(BodyId id) {
  std::vector<BodyId> group = {id};
  while (!group.empty()) {
    Body& body = at(group.back());
    group.pop_back();
    if (!body.frozen) continue;
    rouse(body);
    for (const Support& support : body.supports) group.push_back(support.other);
  }
}

/// Contacts between a frozen and another body: who is loaded, or about to be touched by what has moved (contacts are
/// made within contact_threshold, ahead of touching), and who was come near to.
void World::Impl::find_touched(Touched& touched) const {
  std::map<std::pair<BodyId, BodyId>, double> forces;  // frozen, awake -> N
  for (int m = 0; m < dispatcher->getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(m);
    if (manifold.getNumContacts() == 0) continue;
    const BodyId a = manifold.getBody0()->getUserIndex(), b = manifold.getBody1()->getUserIndex();
    if (at(a).frozen == at(b).frozen) continue;
    const BodyId frozen = at(a).frozen ? a : b, other = at(a).frozen ? b : a;
    if (at(other).kind == BodyKind::kFree)
      forces[{frozen, other}] += force_of(manifold, last_step);
    else if (at(other).kind == BodyKind::kLip)
      touched.by_lip.push_back(frozen);
    else if (at(other).kind == BodyKind::kMoved)
      touched.by_tool.push_back(frozen);
  }
  for (const auto& [pair, force] : forces) {
    const Body &frozen = at(pair.first), &other = at(pair.second);
    const auto support = std::find_if(frozen.supports.begin(), frozen.supports.end(),
                                      [second = pair.second](const Support& s) { return s.other == second; });
    const bool known = support != frozen.supports.end();
    const double limit = config.wake_weights * frozen.mass * config.gravity + (known ? support->force : 0);
    const bool moved = motion_of(other, known ? support->X_WM : other.X_rest) > config.wake_motion;
    if (force > kHeavyWeights * frozen.mass * config.gravity + limit)
      touched.by_tool.push_back(pair.first);
    else if (force > limit || moved)
      touched.loaded.push_back(pair.first);
  }
}

bool World::Impl::support_moved(const Body& frozen) const {
  return std::any_of(frozen.supports.begin(), frozen.supports.end(), [&](const Support& support) {
    const Body& other = at(support.other);
    return !other.frozen && (!other.present || motion_of(other, support.X_WM) > config.wake_motion);
  });
}

/// After a step: who wakes, and who has fallen asleep.
void World::Impl::update_frozen() {
  Touched touched;
  std::vector<BodyId> asleep;
  find_touched(touched);
  for (BodyId id = 0; id < static_cast<BodyId>(bodies.size()); ++id) {
    const Body& body = at(id);
    if (body.frozen && support_moved(body)) touched.loaded.push_back(id);
    if (body.kind == BodyKind::kFree && body.present && !body.frozen && is_still(*body.rigid)) asleep.push_back(id);
  }
  for (const BodyId id : touched.loaded) rouse(at(id));
  for (const BodyId id : touched.by_lip) thaw_near(id);
  for (const BodyId id : touched.by_tool) thaw_group(id);
  if (!asleep.empty()) freeze(asleep);
}

void World::freeze_sleeping() {
  if (!impl_->config.freeze_far) return;
  impl_->freezing = true;
  std::vector<BodyId> asleep;
  for (BodyId id = 0; id < body_count(); ++id)
    if (kind(id) == BodyKind::kFree && present(id) && !awake(id) && !impl_->at(id).frozen) asleep.push_back(id);
  impl_->freeze(asleep);
}

void World::end_freezing() {
  impl_->freezing = false;
  for (Impl::Body& body : impl_->bodies) impl_->thaw(body);
}

int World::frozen_count() const {
  return static_cast<int>(
      std::count_if(impl_->bodies.begin(), impl_->bodies.end(), [](const auto& b) { return b.frozen; }));
}

}  // namespace binpick

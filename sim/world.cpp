// Settings (reference: measurements with Bullet 3.24, float64):
//   double precision, metres: single precision in metres never comes to rest;
//   two friction directions: with one, sleeping heaps creep by millimetres and lie flatter than they should;
//   the solver must converge where a heap comes to rest: of 120 bearings at rest 62 % crept by more than 0.1 mm in two
//     seconds with 50 iterations of the coarse step, 5 % with 250. The fine step needs far fewer, and has most steps;
//   friction starts from the last step's impulses as the normal forces do (HeapSolver), all of them, not 85 %: then 150
//     iterations of the coarse step leave none of 360 bearings creeping;
//   in fine steps pairs that hardly move keep their contact points (QuietPairs): 100 bearings settle in 0.7 of the
//   time; step 1/1000 while anything is fast, else 1/240: keeps impact penetration below 0.6 mm; contact threshold 2 mm
//   absolute: Bullet's 20 mm fattens every bounding box and keeps stale contacts; deterministic overlapping pairs:
//   pairs are sorted, so that addresses decide nothing.
#include "sim/world.hpp"

#include <algorithm>
#include <mutex>

#include "core/check.hpp"
#include "core/hash.hpp"
#include "sim/heap_dynamics.hpp"
#include "sim/heap_solver.hpp"
#include "sim/world_impl.hpp"

namespace binpick {
namespace {

constexpr double kTimeToSleep = 0.5;    // s
constexpr double kSearchMotion = 5e-5;  // m: pairs that moved less are not searched anew in a fine step
constexpr double kBoxMargin = 2e-3;  // m, added to the boxes of the broad phase; Bullet's 50 mm is as large as a part

/// Bullet keeps three of its settings in process-wide variables.
void set_engine_globals(const PhysicsConfig& config) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  if (gContactBreakingThreshold != config.contact_threshold) gContactBreakingThreshold = config.contact_threshold;
  if (gDbvtMargin != kBoxMargin) gDbvtMargin = kBoxMargin;
  if (gDeactivationTime != kTimeToSleep) gDeactivationTime = kTimeToSleep;
}

void set_solver(btContactSolverInfo& info) {
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS;
  info.m_warmstartingFactor = 1;
  info.m_erp = 0.2;
  info.m_erp2 = 0.2;
  info.m_splitImpulse = true;
  info.m_splitImpulsePenetrationThreshold = -0.01e-3;  // m: depth is undone without adding speed; -40 mm means never
  info.m_restitutionVelocityThreshold = 0.1;           // m/s: above what gravity adds in one coarse step
}

}  // namespace

bool World::Impl::PairFilter::needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const {
  if ((a->m_collisionFilterGroup & b->m_collisionFilterMask) == 0) return false;
  if ((b->m_collisionFilterGroup & a->m_collisionFilterMask) == 0) return false;
  if (ignored.empty()) return true;
  const int i = static_cast<const btCollisionObject*>(a->m_clientObject)->getUserIndex();
  const int j = static_cast<const btCollisionObject*>(b->m_clientObject)->getUserIndex();
  return !ignored.contains({std::min(i, j), std::max(i, j)});
}

World::Impl::Impl(const PhysicsConfig& physics) : config(physics) {
  // Headers of one precision with the library of the other fail in silence.
  BP_CHECK(sizeof(btScalar) == sizeof(double), "Bullet must be built in double precision");
  set_engine_globals(config);
  collision_configuration = std::make_unique<btDefaultCollisionConfiguration>();
  dispatcher = std::make_unique<QuietPairs>(collision_configuration.get());
  dispatcher->setDispatcherFlags(dispatcher->getDispatcherFlags() &
                                 ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
  broadphase = std::make_unique<btDbvtBroadphase>();
  solver = std::make_unique<HeapSolver>();
  world =
      std::make_unique<HeapDynamics>(dispatcher.get(), broadphase.get(), solver.get(), collision_configuration.get());
  world->setGravity({0, 0, -config.gravity});
  world->getDispatchInfo().m_deterministicOverlappingPairs = true;
  set_solver(world->getSolverInfo());
  broadphase->getOverlappingPairCache()->setOverlapFilterCallback(&filter);
}

World::Impl::~Impl() {
  for (Body& body : bodies)
    if (body.present) world->removeRigidBody(body.rigid.get());
}

World::Impl::Body& World::Impl::at(BodyId body) {
  BP_CHECK(body >= 0 && body < static_cast<int>(bodies.size()), "body " << body << " of " << bodies.size());
  return bodies[static_cast<std::size_t>(body)];
}

const World::Impl::Body& World::Impl::at(BodyId body) const { return const_cast<Impl*>(this)->at(body); }

/// Moved bodies stand at the start of the step and carry the velocity that leads to the target, as free bodies do:
/// contacts and holds feel the motion, and nothing lags or leads by v dt. Bullet takes the velocity from the last
/// interpolation pose, so that pose is set to the mirror image of the target.
void World::Impl::aim_moved_bodies() {
  for (Body& body : bodies) {
    if (body.kind != BodyKind::kMoved || !body.moving) continue;
    const btTransform now = body.rigid->getWorldTransform(), target = to_bullet(body.X_WO_target);
    const btMatrix3x3 turn = target.getBasis() * now.getBasis().transpose();
    body.rigid->setInterpolationWorldTransform(
        btTransform(turn.transpose() * now.getBasis(), 2 * now.getOrigin() - target.getOrigin()));
    body.rigid->forceActivationState(DISABLE_DEACTIVATION);
  }
}

void World::Impl::land_moved_bodies() {
  for (Body& body : bodies) {
    if (body.kind != BodyKind::kMoved || !body.moving) continue;
    const btTransform target = to_bullet(body.X_WO_target);
    const btVector3 shift = target.getOrigin() - body.rigid->getWorldTransform().getOrigin();
    const bool moved = shift.length2() > 0 || !(target.getBasis() == body.rigid->getWorldTransform().getBasis());
    body.rigid->setWorldTransform(target);
    body.rigid->setInterpolationWorldTransform(target);
    if (moved) continue;
    // It stood still for a whole step: asleep it no longer wakes what it touches.
    body.moving = false;
    body.rigid->setLinearVelocity({0, 0, 0});
    body.rigid->setAngularVelocity({0, 0, 0});
    body.rigid->forceActivationState(ISLAND_SLEEPING);
  }
}

void World::Impl::advance(double dt, int iterations, double search_motion) {
  BP_CHECK(dt > 0, dt);
  set_engine_globals(config);
  dispatcher->set_tolerance(search_motion);
  manifolds_known = false;
  if (observer) observer->before_step(dt, iterations);
  world->getSolverInfo().m_numIterations = iterations;
  aim_moved_bodies();
  world->stepSimulation(dt, 0);
  land_moved_bodies();
  time += dt;
  last_step = dt;
  if (freezing) update_frozen();
  if (observer) observer->after_step();
}

World::World(const PhysicsConfig& config) : impl_(std::make_unique<Impl>(config)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

double World::step() {
  double fastest = 0;
  for (const Impl::Body& body : impl_->bodies) {
    if (body.kind != BodyKind::kFree || !body.present || !body.rigid->isActive()) continue;
    const double speed = body.rigid->getLinearVelocity().length();
    fastest = std::max(fastest, speed + body.rigid->getAngularVelocity().length() * body.geometry->radius);
  }
  const bool fast = fastest > impl_->config.fast_speed;
  const double dt = fast ? impl_->config.fine_step : impl_->config.coarse_step;
  if (fast)
    impl_->advance(dt, impl_->config.fine_iterations, kSearchMotion);
  else
    impl_->advance(dt, impl_->config.coarse_iterations, 0);
  return dt;
}

double World::step(double dt) {
  impl_->advance(dt, impl_->config.iterations, 0);
  return dt;
}

std::uint64_t World::state_hash() const {
  Hasher hasher;
  for (const Impl::Body& body : impl_->bodies) {
    const btTransform& X = body.rigid->getWorldTransform();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) hasher.add(X.getBasis()[row][column]);
      hasher.add(X.getOrigin()[row]);
      hasher.add(body.rigid->getLinearVelocity()[row]);
      hasher.add(body.rigid->getAngularVelocity()[row]);
    }
    hasher.add(static_cast<std::uint64_t>(body.present));
  }
  return hasher.value();
}

}  // namespace binpick

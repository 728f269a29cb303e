#include "sim/bare_bullet.hpp"

#include <map>

#include "core/check.hpp"
#include "sim/heap_dynamics.hpp"
#include "sim/heap_solver.hpp"
#include "sim/world_impl.hpp"

namespace binpick {
namespace {

std::unique_ptr<btCollisionShape> copy_of(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return std::make_unique<btConvexHullShape>(static_cast<const btConvexHullShape&>(shape));
    case BOX_SHAPE_PROXYTYPE:
      return std::make_unique<btBoxShape>(static_cast<const btBoxShape&>(shape));
    case CYLINDER_SHAPE_PROXYTYPE:
      return std::make_unique<btCylinderShapeZ>(static_cast<const btCylinderShapeZ&>(shape));
    case SPHERE_SHAPE_PROXYTYPE:
      return std::make_unique<btSphereShape>(static_cast<const btSphereShape&>(shape));
    case CAPSULE_SHAPE_PROXYTYPE:
      return std::make_unique<btCapsuleShape>(static_cast<const btCapsuleShape&>(shape));
  }
  BP_CHECK(false, "no copy of a " << shape.getName());
  return nullptr;
}

bool same_motion(const btRigidBody& a, const btRigidBody& b) {
  return a.getWorldTransform() == b.getWorldTransform() && a.getLinearVelocity() == b.getLinearVelocity() &&
         a.getAngularVelocity() == b.getAngularVelocity();
}

bool same_state(const btRigidBody& a, const btRigidBody& b) {
  return same_motion(a, b) && a.getActivationState() == b.getActivationState() &&
         a.getDeactivationTime() == b.getDeactivationTime() && a.getLinearDamping() == b.getLinearDamping() &&
         a.getAngularDamping() == b.getAngularDamping();
}

}  // namespace

struct BareBullet::Impl : World::Impl::Observer {
  struct Shape {
    std::vector<std::unique_ptr<btCollisionShape>> children;
    std::unique_ptr<btCompoundShape> compound;
  };
  struct Twin {
    std::unique_ptr<btRigidBody> rigid;
    bool present = false;
  };
  /// Our own clock stands still while one of these lives.
  struct Pause {
    explicit Pause(Impl& watcher) : impl(watcher) { impl.report.ours += impl.cpu_now() - impl.resumed; }
    ~Pause() { impl.resumed = impl.cpu_now(); }
    Impl& impl;
  };

  Impl(World::Impl& observed, std::function<double()> cpu)
      : ours(observed), cpu_now(std::move(cpu)), dispatcher(&configuration) {
    world = std::make_unique<HeapDynamics>(&dispatcher, &broadphase, &solver, &configuration);
    dispatcher.setDispatcherFlags(ours.dispatcher->getDispatcherFlags());
    world->setGravity(ours.world->getGravity());
    world->getDispatchInfo().m_deterministicOverlappingPairs =
        ours.world->getDispatchInfo().m_deterministicOverlappingPairs;
    world->getSolverInfo() = ours.world->getSolverInfo();
    BP_CHECK(ours.observer == nullptr, "a World is watched twice");
    BP_CHECK(ours.bodies.empty(), "the bare world has to see every body come");
    ours.observer = this;
    resumed = cpu_now();
  }
  ~Impl() override {
    ours.observer = nullptr;
    for (Twin& twin : twins)
      if (twin.present) world->removeRigidBody(twin.rigid.get());
  }

  void joined(const World::Impl::Body& body) override {
    const Pause pause(*this);
    const auto id = static_cast<std::size_t>(body.rigid->getUserIndex());
    if (id == twins.size()) twins.push_back({rigid_of(body), false});
    take_state(*twins.at(id).rigid, *body.rigid);
    world->addRigidBody(twins[id].rigid.get());
    twins[id].present = true;
  }

  void left(const World::Impl::Body& body) override {
    const Pause pause(*this);
    Twin& twin = twins.at(static_cast<std::size_t>(body.rigid->getUserIndex()));
    world->removeRigidBody(twin.rigid.get());
    twin.present = false;
  }

  void before_step(double dt, int iterations) override {
    const Pause pause(*this);
    follow();
    world->getSolverInfo().m_numIterations = iterations;
    dispatcher.set_tolerance(ours.dispatcher->tolerance());
    length = dt;
    if (report.steps % 2 == 0) step();
  }

  void after_step() override {
    const Pause pause(*this);
    if (report.steps % 2 == 1) step();
    bool equal = true;
    for (std::size_t i = 0; i < twins.size(); ++i)
      equal = equal && (!twins[i].present || same_motion(*twins[i].rigid, *ours.bodies[i].rigid));
    report.different += equal ? 0 : 1;
    ++report.steps;
    report.simulated += length;
  }

  void step() {
    const double start = cpu_now();
    world->stepSimulation(length, 0);
    report.bare += cpu_now() - start;
  }

  /// What was done to our bodies since the last step: they were pushed, damped, woken, put to sleep.
  void follow() {
    for (std::size_t i = 0; i < ours.bodies.size(); ++i) {
      const World::Impl::Body& body = ours.bodies[i];
      BP_CHECK(!body.frozen && body.kind != World::BodyKind::kMoved, "only what is dropped can be copied");
      if (body.present && !same_state(*twins[i].rigid, *body.rigid)) take_state(*twins[i].rigid, *body.rigid);
    }
  }

  static void take_state(btRigidBody& twin, const btRigidBody& body) {
    twin.setWorldTransform(body.getWorldTransform());
    twin.setInterpolationWorldTransform(body.getInterpolationWorldTransform());
    twin.setLinearVelocity(body.getLinearVelocity());
    twin.setAngularVelocity(body.getAngularVelocity());
    twin.setInterpolationLinearVelocity(body.getInterpolationLinearVelocity());
    twin.setInterpolationAngularVelocity(body.getInterpolationAngularVelocity());
    twin.setDamping(body.getLinearDamping(), body.getAngularDamping());
    twin.forceActivationState(body.getActivationState());
    twin.setDeactivationTime(body.getDeactivationTime());
  }

  std::unique_ptr<btRigidBody> rigid_of(const World::Impl::Body& body) {
    const btRigidBody& rigid = *body.rigid;
    btRigidBody::btRigidBodyConstructionInfo info(rigid.getMass(), nullptr, compound_of(*body.geometry),
                                                  rigid.getLocalInertia());
    info.m_startWorldTransform = rigid.getWorldTransform();
    info.m_friction = rigid.getFriction();
    info.m_restitution = rigid.getRestitution();
    info.m_rollingFriction = rigid.getRollingFriction();
    info.m_spinningFriction = rigid.getSpinningFriction();
    info.m_linearSleepingThreshold = rigid.getLinearSleepingThreshold();
    info.m_angularSleepingThreshold = rigid.getAngularSleepingThreshold();
    auto twin = std::make_unique<btRigidBody>(info);
    twin->setUserIndex(rigid.getUserIndex());
    return twin;
  }

  btCompoundShape* compound_of(const World::Impl::Geometry& geometry) {
    Shape& shape = shapes[&geometry];
    if (shape.compound) return shape.compound.get();
    const btCompoundShape& source = *geometry.compound;
    shape.compound = std::make_unique<btCompoundShape>(true, source.getNumChildShapes());
    shape.compound->setMargin(source.getMargin());
    for (int i = 0; i < source.getNumChildShapes(); ++i) {
      shape.children.push_back(copy_of(*source.getChildShape(i)));
      shape.compound->addChildShape(source.getChildTransform(i), shape.children.back().get());
    }
    return shape.compound.get();
  }

  World::Impl& ours;
  std::function<double()> cpu_now;
  btDefaultCollisionConfiguration configuration;
  QuietPairs dispatcher;
  btDbvtBroadphase broadphase;
  HeapSolver solver;
  std::unique_ptr<btDiscreteDynamicsWorld> world;
  std::map<const World::Impl::Geometry*, Shape> shapes;  ///< looked up only: its order decides nothing
  std::vector<Twin> twins;
  double length = 0, resumed = 0;
  Report report;
};

BareBullet::BareBullet(World& world, std::function<double()> cpu_now)
    : impl_(std::make_unique<Impl>(world.impl(), std::move(cpu_now))) {}

BareBullet::~BareBullet() = default;

BareBullet::Report BareBullet::report() const {
  Report report = impl_->report;
  report.ours += impl_->cpu_now() - impl_->resumed;
  return report;
}

}  // namespace binpick

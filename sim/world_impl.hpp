// Private to sim: the Bullet objects behind World. Frames: O or P is the owner's frame, M the frame of the rigid body
// (mass centre and principal axes); X_WP = X_WM * X_PM^-1. Fixed and moved bodies have M = O.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "sim/bullet_convert.hpp"
#include "sim/quiet_pairs.hpp"
#include "sim/world.hpp"

namespace binpick {

struct World::Impl {
  /// Collision geometry of one solid: hulls and primitives under one compound. Shared by the instances of a part.
  struct Geometry {
    std::vector<std::unique_ptr<btCollisionShape>> children;
    std::unique_ptr<btCompoundShape> compound;
    double radius = 0;  ///< m, of the sphere about M that holds everything
  };
  /// What a frozen body touched when it was frozen.
  struct Support {
    BodyId other;
    double force;      ///< N
    btTransform X_WM;  ///< of the other one, then
  };
  /// Frozen bodies that have to wake, by what came to them.
  struct Touched {
    std::vector<BodyId> loaded, by_lip, by_tool;  ///< a heavy load counts as a tool
  };
  struct Body {
    BodyKind kind = BodyKind::kFixed;
    std::shared_ptr<Geometry> geometry;
    std::unique_ptr<btRigidBody> rigid;
    Pose X_OM = Pose::Identity();
    Pose X_WO_target = Pose::Identity();  ///< moved bodies: where the next step ends
    bool moving = false;                  ///< moved bodies: a target is set or the last step moved it
    bool present = true;
    bool frozen = false;
    double mass = 0;  ///< kg, and the moments of inertia: what a frozen body gets back
    btVector3 inertia_M{0, 0, 0};
    btTransform X_rest = btTransform::getIdentity();  ///< X_WM when it was last frozen
    std::vector<Support> supports;
  };
  /// Pairs of bodies that ignore each other, by id.
  struct PairFilter : btOverlapFilterCallback {
    std::set<std::pair<int, int>> ignored;
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;
  };

  /// Is told of every step, and of bodies that enter and leave the simulation (bare_bullet.cpp).
  struct Observer {
    virtual ~Observer() = default;
    virtual void joined(const Body& body) = 0;
    virtual void left(const Body& body) = 0;
    virtual void before_step(double dt, int iterations) = 0;
    virtual void after_step() = 0;
  };

  explicit Impl(const PhysicsConfig& physics);
  ~Impl();

  BodyId add(Body body, double mass, const Eigen::Vector3d& inertia_M, const Pose& X_WO,
             const SurfaceMaterial& material);
  std::shared_ptr<Geometry> part_geometry(const Part& part, const CollisionShape& shape, const Pose& X_PM);
  std::shared_ptr<Geometry> primitive_geometry(std::span<const Primitive> shapes_O) const;
  /// Adds the hulls of `pieces_M`, which are placed in the compound's own frame.
  void add_hulls(Geometry& geometry, std::span<const TriangleMesh> pieces_M) const;
  Body& at(BodyId body);
  const Body& at(BodyId body) const;
  void join_world(Body& body);
  /// `search_motion`: QuietPairs::set_tolerance.
  void advance(double dt, int iterations, double search_motion);
  /// The manifolds with contacts of a body, in the dispatcher's order. Sorted by body once a step: an arm's nine bodies
  /// are asked about in every one.
  const std::vector<const btPersistentManifold*>& manifolds_of(BodyId body);
  void aim_moved_bodies();
  void land_moved_bodies();

  void freeze(const std::vector<BodyId>& ids);
  void thaw(Body& body);
  void rouse(Body& body);
  void thaw_near(BodyId id);
  void thaw_group(BodyId id);
  void note_support(BodyId id, BodyId other, double force);
  bool support_moved(const Body& frozen) const;
  void find_touched(Touched& touched) const;
  void update_frozen();
  double motion_of(const Body& body, const btTransform& X_since) const;

  PhysicsConfig config;
  double time = 0;
  double last_step = 0;
  bool freezing = false;
  Observer* observer = nullptr;
  std::unique_ptr<btDefaultCollisionConfiguration> collision_configuration;
  std::unique_ptr<QuietPairs> dispatcher;
  std::unique_ptr<btDbvtBroadphase> broadphase;
  std::unique_ptr<btSequentialImpulseConstraintSolver> solver;
  std::unique_ptr<btDiscreteDynamicsWorld> world;
  PairFilter filter;
  std::vector<Body> bodies;
  std::map<std::uint64_t, std::shared_ptr<Geometry>> part_geometries;  ///< by content
  std::vector<std::vector<const btPersistentManifold*>> manifolds;     ///< by body, once asked for
  bool manifolds_known = false;
};

}  // namespace binpick

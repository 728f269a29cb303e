// Private to sim: the Bullet objects behind World. Frames: O or P is the owner's frame, M the frame of the rigid body
// (mass centre and principal axes); X_WP = X_WM * X_PM^-1. Fixed and moved bodies have M = O.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "sim/bullet_convert.hpp"
#include "sim/world.hpp"

namespace binpick {

struct World::Impl {
  /// Collision geometry of one solid: hulls and primitives under one compound. Shared by the instances of a part.
  struct Geometry {
    std::vector<std::unique_ptr<btCollisionShape>> children;
    std::unique_ptr<btCompoundShape> compound;
    double radius = 0;  ///< m, of the sphere about M that holds everything
  };
  struct Body {
    BodyKind kind = BodyKind::kFixed;
    std::shared_ptr<Geometry> geometry;
    std::unique_ptr<btRigidBody> rigid;
    Pose X_OM = Pose::Identity();
    Pose X_WO_target = Pose::Identity();  ///< moved bodies: where the next step ends
    bool moving = false;                  ///< moved bodies: a target is set or the last step moved it
    bool present = true;
  };
  /// Pairs of bodies that ignore each other, by id.
  struct PairFilter : btOverlapFilterCallback {
    std::set<std::pair<int, int>> ignored;
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;
  };

  explicit Impl(const PhysicsConfig& physics);
  ~Impl();

  BodyId add(Body body, double mass, const Eigen::Vector3d& inertia_M, const Pose& X_WO,
             const SurfaceMaterial& material);
  std::shared_ptr<Geometry> part_geometry(const Part& part, const CollisionShape& shape, const Pose& X_PM);
  std::shared_ptr<Geometry> primitive_geometry(std::span<const Primitive> shapes_O) const;
  Body& at(BodyId body);
  const Body& at(BodyId body) const;
  void join_world(Body& body);
  void advance(double dt);
  void aim_moved_bodies();
  void land_moved_bodies();

  PhysicsConfig config;
  double time = 0;
  double last_step = 0;
  std::unique_ptr<btDefaultCollisionConfiguration> collision_configuration;
  std::unique_ptr<btCollisionDispatcher> dispatcher;
  std::unique_ptr<btDbvtBroadphase> broadphase;
  std::unique_ptr<btSequentialImpulseConstraintSolver> solver;
  std::unique_ptr<btDiscreteDynamicsWorld> world;
  PairFilter filter;
  std::vector<Body> bodies;
  std::map<std::uint64_t, std::shared_ptr<Geometry>> part_geometries;  ///< by content
};

}  // namespace binpick

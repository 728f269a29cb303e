// Bodies of the world: collision geometry with margins, mass and inertia, materials.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/hash.hpp"
#include "sim/reduced_hull.hpp"
#include "sim/world_impl.hpp"

namespace binpick {
namespace {

/// Mass centre and principal axes of a part, right-handed.
Pose principal_frame(const MassProperties& mass, Eigen::Vector3d& inertia_M) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(mass.inertia_P);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  inertia_M = solver.eigenvalues();
  return pose_from(axes, mass.center_P);
}

/// A hull whose faces, margin included, are those of the piece. The margin is set before the points are added: they
/// cache a bounding box that contains it.
std::unique_ptr<btConvexHullShape> hull_shape(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& centre,
                                              double margin) {
  const InsetHull inset = inset_hull(points, margin);
  auto hull = std::make_unique<btConvexHullShape>();
  hull->setMargin(std::max(inset.inset, 1e-5));
  for (const Eigen::Vector3d& p : inset.vertices) hull->addPoint(to_bullet(Eigen::Vector3d(p - centre)), false);
  hull->recalcLocalAabb();
  return hull;
}

std::unique_ptr<btCollisionShape> primitive_shape(const Primitive& primitive, double margin) {
  const Eigen::Vector3d& size = primitive.size;
  if (primitive.kind == Primitive::Kind::kSphere) return std::make_unique<btSphereShape>(size.x());
  std::unique_ptr<btConvexInternalShape> shape;
  double smallest = size.minCoeff() / 2;
  if (primitive.kind == Primitive::Kind::kBox) {
    shape = std::make_unique<btBoxShape>(to_bullet(Eigen::Vector3d(size / 2)));
  } else {
    shape = std::make_unique<btCylinderShapeZ>(btVector3(size.x(), size.x(), size.y() / 2));
    smallest = std::min(size.x(), size.y() / 2);
  }
  shape->setMargin(std::min(margin, 0.4 * smallest));  // boxes and cylinders take the margin off inside
  return shape;
}

/// A free ball is a capsule of no length: Bullet makes the contact of two spheres anew in every step, without the
/// impulse it had, and heaps of them never come to rest.
std::unique_ptr<btCollisionShape> ball_shape(double radius) { return std::make_unique<btCapsuleShapeZ>(radius, 0); }

void add_child(World::Impl::Geometry& geometry, std::unique_ptr<btCollisionShape> child, const Pose& X_MS) {
  geometry.compound->addChildShape(to_bullet(X_MS), child.get());
  geometry.children.push_back(std::move(child));
}

std::uint64_t content_of(const Part& part, const CollisionShape& shape) {
  Hasher hasher;
  hasher.add(part.mass.mass);
  for (int i = 0; i < 9; ++i) hasher.add(part.mass.inertia_P.data()[i]);
  for (int i = 0; i < 3; ++i) hasher.add(part.mass.center_P[i]);
  for (const TriangleMesh& piece : shape.pieces_P) {
    hasher.add(static_cast<std::uint64_t>(piece.vertices.size()));
    for (const Eigen::Vector3d& v : piece.vertices)
      for (int i = 0; i < 3; ++i) hasher.add(v[i]);
  }
  for (const Primitive& solid : shape.solids_P) {
    hasher.add(static_cast<std::uint64_t>(solid.kind));
    for (int i = 0; i < 3; ++i) hasher.add(solid.size[i]);
    hasher.add(solid.X_OS);
  }
  return hasher.value();
}

/// Bullet multiplies the coefficients of a pair: square roots give the geometric mean, so that equal materials have the
/// stated value.
double pair_root(double coefficient) { return std::sqrt(coefficient); }

}  // namespace

std::shared_ptr<World::Impl::Geometry> World::Impl::part_geometry(const Part& part, const CollisionShape& shape,
                                                                  const Pose& X_PM) {
  std::shared_ptr<Geometry>& geometry = part_geometries[content_of(part, shape)];
  if (geometry) return geometry;
  geometry = std::make_shared<Geometry>();
  const std::size_t children = shape.pieces_P.size() + shape.solids_P.size();
  geometry->compound = std::make_unique<btCompoundShape>(true, static_cast<int>(children));
  geometry->compound->setMargin(config.margin);
  const Pose X_MP = X_PM.inverse();
  std::vector<TriangleMesh> pieces_M;
  for (const TriangleMesh& piece : shape.pieces_P) pieces_M.push_back(transformed(X_MP, piece));
  add_hulls(*geometry, pieces_M);
  for (const Primitive& solid : shape.solids_P) {
    for (const Eigen::Vector3d& v : mesh_of(solid, 12).vertices)
      geometry->radius = std::max(geometry->radius, (X_MP * v).norm());
    const bool ball = solid.kind == Primitive::Kind::kSphere;
    add_child(*geometry, ball ? ball_shape(solid.size.x()) : primitive_shape(solid, config.margin), X_MP * solid.X_OS);
  }
  return geometry;
}

void World::Impl::add_hulls(Geometry& geometry, std::span<const TriangleMesh> pieces_M) const {
  for (const TriangleMesh& piece : pieces_M) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& v : piece.vertices) {
      centre += v / static_cast<double>(piece.vertices.size());
      geometry.radius = std::max(geometry.radius, v.norm());
    }
    add_child(geometry, hull_shape(piece.vertices, centre, config.margin), Pose(Eigen::Translation3d(centre)));
  }
}

std::shared_ptr<World::Impl::Geometry> World::Impl::primitive_geometry(std::span<const Primitive> shapes_O) const {
  auto geometry = std::make_shared<Geometry>();
  geometry->compound = std::make_unique<btCompoundShape>(true, static_cast<int>(shapes_O.size()));
  geometry->compound->setMargin(config.margin);
  for (const Primitive& primitive : shapes_O) {
    for (const Eigen::Vector3d& v : mesh_of(primitive, 12).vertices)
      geometry->radius = std::max(geometry->radius, v.norm());
    add_child(*geometry, primitive_shape(primitive, config.margin), primitive.X_OS);
  }
  return geometry;
}

void World::Impl::join_world(Body& body) {
  manifolds_known = false;
  const bool is_free = body.kind == BodyKind::kFree || body.kind == BodyKind::kLip;
  // Fixed and moved bodies meet free ones only.
  world->addRigidBody(body.rigid.get(), is_free ? btBroadphaseProxy::DefaultFilter : btBroadphaseProxy::StaticFilter,
                      is_free ? btBroadphaseProxy::AllFilter : btBroadphaseProxy::DefaultFilter);
  if (observer) observer->joined(body);
}

BodyId World::Impl::add(Body body, double mass, const Eigen::Vector3d& inertia_M, const Pose& X_WO,
                        const SurfaceMaterial& material) {
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, body.geometry->compound.get(), to_bullet(inertia_M));
  info.m_startWorldTransform = to_bullet(Pose(X_WO * body.X_OM));
  info.m_friction = pair_root(material.friction);
  info.m_restitution = pair_root(material.restitution);
  if (body.kind == BodyKind::kFree) {
    // Bullet's pair value is r1 f2 + r2 f1: divided by f, a part on anything alike has the stated lever arm (two parts
    // twice).
    info.m_rollingFriction = config.rolling_friction / std::max(pair_root(material.friction), 0.05);
    info.m_spinningFriction = info.m_rollingFriction;
    info.m_linearSleepingThreshold = 0.01;  // m/s; Bullet's own 0.8 puts tilted parts to sleep
    info.m_angularSleepingThreshold = 0.1;  // rad/s
  }
  body.rigid = std::make_unique<btRigidBody>(info);
  body.rigid->setUserIndex(static_cast<int>(bodies.size()));
  body.X_WO_target = X_WO;
  if (body.kind == BodyKind::kMoved) {
    body.rigid->setCollisionFlags(body.rigid->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    body.rigid->forceActivationState(ISLAND_SLEEPING);  // an awake moved body wakes whatever its box overlaps
  }
  bodies.push_back(std::move(body));
  join_world(bodies.back());
  return static_cast<BodyId>(bodies.size()) - 1;
}

BodyId World::add_free(const Part& part, const CollisionShape& shape, const Pose& X_WP) {
  BP_CHECK(part.mass.mass > 0, part.name << " has mass " << part.mass.mass);
  Impl::Body body;
  Eigen::Vector3d inertia_M;
  body.kind = BodyKind::kFree;
  body.X_OM = principal_frame(part.mass, inertia_M);
  BP_CHECK(inertia_M.minCoeff() > 0, part.name << " has inertia " << inertia_M.transpose());
  body.geometry = impl_->part_geometry(part, shape, body.X_OM);
  return impl_->add(std::move(body), part.mass.mass, inertia_M, X_WP, {part.friction, part.restitution});
}

BodyId World::add_fixed(std::span<const Primitive> shapes_O, const Pose& X_WO, const SurfaceMaterial& material) {
  Impl::Body body;
  body.geometry = impl_->primitive_geometry(shapes_O);
  return impl_->add(std::move(body), 0, Eigen::Vector3d::Zero(), X_WO, material);
}

BodyId World::add_fixed_hulls(std::span<const TriangleMesh> convex_O, const Pose& X_WO, const SurfaceMaterial& material) {
  Impl::Body body;
  body.geometry = std::make_shared<Impl::Geometry>();
  body.geometry->compound = std::make_unique<btCompoundShape>(true, static_cast<int>(convex_O.size()));
  body.geometry->compound->setMargin(impl_->config.margin);
  impl_->add_hulls(*body.geometry, convex_O);
  return impl_->add(std::move(body), 0, Eigen::Vector3d::Zero(), X_WO, material);
}

BodyId World::add_moved(std::span<const Primitive> shapes_O, const Pose& X_WO, const SurfaceMaterial& material) {
  Impl::Body body;
  body.kind = BodyKind::kMoved;
  body.geometry = impl_->primitive_geometry(shapes_O);
  return impl_->add(std::move(body), 0, Eigen::Vector3d::Zero(), X_WO, material);
}

}  // namespace binpick

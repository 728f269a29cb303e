#include "robot/primitive_distance.hpp"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>
#include <cmath>
#include <variant>

namespace binpick {
namespace {

using Shape = std::variant<btBoxShape, btCylinderShapeZ, btSphereShape>;

/// A sphere is a point with a radius: GJK without margins sees the point only.
double extra_radius(const Primitive& p) { return p.kind == Primitive::Kind::kSphere ? p.size.x() : 0; }

Shape shape_of(const Primitive& p) {
  switch (p.kind) {
    case Primitive::Kind::kBox:
      return btBoxShape(btVector3(p.size.x() / 2, p.size.y() / 2, p.size.z() / 2));
    case Primitive::Kind::kCylinder:
      return btCylinderShapeZ(btVector3(p.size.x(), p.size.x(), p.size.y() / 2));
    case Primitive::Kind::kSphere:
      break;
  }
  return btSphereShape(p.size.x());
}

btTransform transform_of(const Pose& X) {
  const auto& R = X.linear();
  const Eigen::Vector3d p = X.translation();
  return btTransform(btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
                     btVector3(p.x(), p.y(), p.z()));
}

}  // namespace

double signed_distance_S(const Primitive& shape, const Eigen::Vector3d& p_S) {
  if (shape.kind == Primitive::Kind::kSphere) return p_S.norm() - shape.size.x();
  if (shape.kind == Primitive::Kind::kCylinder) {
    const Eigen::Vector2d over(p_S.head<2>().norm() - shape.size.x(), std::abs(p_S.z()) - shape.size.y() / 2);
    return over.cwiseMax(0).norm() + std::min(0.0, over.maxCoeff());
  }
  const Eigen::Vector3d over = p_S.cwiseAbs() - shape.size / 2;
  return over.cwiseMax(0).norm() + std::min(0.0, over.maxCoeff());
}

double distance(const Primitive& a, const Pose& X_WSa, const Primitive& b, const Pose& X_WSb) {
  Shape shape_a = shape_of(a), shape_b = shape_of(b);
  // The solids' outer size does not depend on Bullet's margin; without one GJK works on the exact solids.
  const auto base = [](auto& shape) -> btConvexShape* { return &shape; };
  btConvexShape* const on_a = std::visit(base, shape_a);
  btConvexShape* const on_b = std::visit(base, shape_b);
  if (a.kind != Primitive::Kind::kSphere) on_a->setMargin(0);
  if (b.kind != Primitive::Kind::kSphere) on_b->setMargin(0);
  btGjkEpaSolver2::sResults results;
  const btTransform X_a = transform_of(X_WSa), X_b = transform_of(X_WSb);
  const btVector3 guess = X_b.getOrigin() - X_a.getOrigin();
  const btVector3 safe = guess.length2() > 0 ? guess : btVector3(1, 0, 0);
  if (!btGjkEpaSolver2::Distance(on_a, X_a, on_b, X_b, safe, results)) return 0;
  return std::max(0.0, results.distance - extra_radius(a) - extra_radius(b));
}

double bounding_radius(const Primitive& shape) {
  switch (shape.kind) {
    case Primitive::Kind::kBox:
      return shape.size.norm() / 2;
    case Primitive::Kind::kCylinder:
      return std::hypot(shape.size.x(), shape.size.y() / 2);
    case Primitive::Kind::kSphere:
      break;
  }
  return shape.size.x();
}

Eigen::Vector3d half_extents_W(const Primitive& shape, const Eigen::Matrix3d& R_WS) {
  if (shape.kind == Primitive::Kind::kSphere) return Eigen::Vector3d::Constant(shape.size.x());
  if (shape.kind == Primitive::Kind::kBox) return R_WS.cwiseAbs() * shape.size / 2;
  // A disc of radius r about axis z reaches r sqrt(1 - z_i^2) along axis i.
  const Eigen::Vector3d z = R_WS.col(2);
  return shape.size.x() * (Eigen::Vector3d::Ones() - z.cwiseProduct(z)).cwiseMax(0).cwiseSqrt() +
         z.cwiseAbs() * shape.size.y() / 2;
}

}  // namespace binpick

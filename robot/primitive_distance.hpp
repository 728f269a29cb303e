// Distances of solids: point to primitive in closed form, primitive to primitive through Bullet's GJK. Metres.
#pragma once

#include <Eigen/Core>

#include "core/primitive.hpp"

namespace binpick {

/// Signed distance of a point, given in the primitive's own frame S; negative inside.
double signed_distance_S(const Primitive& shape, const Eigen::Vector3d& p_S);

/// Distance of two primitives whose own frames stand at X_WS; 0 when they touch or overlap.
double distance(const Primitive& a, const Pose& X_WSa, const Primitive& b, const Pose& X_WSb);

/// Radius of the sphere about the origin of S that holds the primitive.
double bounding_radius(const Primitive& shape);

/// Half edges of the primitive's box in W, when its frame S is turned by R_WS.
Eigen::Vector3d half_extents_W(const Primitive& shape, const Eigen::Matrix3d& R_WS);

}  // namespace binpick

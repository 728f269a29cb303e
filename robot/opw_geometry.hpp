// Private to robot: the OPW parameters of a six-joint chain, found from its own joint axes at the zero position, and
// the forward kinematics in those parameters (Brandstoetter, Angerer, Hofbaur 2014).
#pragma once

#include <optional>
#include <string>

#include "robot/arm.hpp"
#include "robot/urdf_reader.hpp"

namespace binpick {

/// Empty when the axes are not those of an ortho-parallel basis (joint 2 perpendicular to 1 and parallel to 3) with a
/// spherical wrist (4, 5 and 6 meet in one point, 5 perpendicular to both); `why_not` then says what is in the way.
std::optional<OpwParameters> find_opw(const SerialChain& chain, std::string& why_not);

/// X_OE at joint angles of the method itself.
Pose opw_forward(const OpwParameters& opw, const Vector6d& q_opw);

Vector6d to_opw(const OpwParameters& opw, const Vector6d& q);
Vector6d from_opw(const OpwParameters& opw, const Vector6d& q_opw);

}  // namespace binpick

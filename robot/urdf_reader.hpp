// Private to robot: a URDF file as a serial chain of six revolute joints. Everything that hangs on fixed joints is
// merged into the rigid link that carries it, so a chain has seven links: the base and one behind every joint.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/primitive.hpp"
#include "robot/arm.hpp"

namespace binpick {

struct SerialChain {
  std::string name, flange_name;
  std::array<std::string, 7> link_names;
  std::array<Pose, 6> X_before;         ///< joint frame in its parent's rigid link, at joint position 0
  std::array<Eigen::Vector3d, 6> axes;  ///< unit, in the joint frame
  std::array<JointLimits, 6> limits;
  Pose X_6F = Pose::Identity();  ///< tip in the last moving link
  std::array<std::vector<Primitive>, 7> shapes;
  std::vector<std::string> mesh_files;  ///< that were read
};

/// Throws AssetError; see Arm::load.
SerialChain read_urdf_chain(const ArmSource& source);

}  // namespace binpick

// Private to robot: the factory function that each gripper kind exports.
#pragma once

#include <memory>

#include "robot/gripper.hpp"

namespace binpick {

std::unique_ptr<Gripper> make_suction();

}  // namespace binpick

// One cup of a tool as a gripper of its own: for places where only one of several lips fits, such as the rim of a ring
// that stands on its edge. Each cup has a valve of its own, so the others may stay open.
#pragma once

#include "robot/pick_sites.hpp"

namespace binpick {

/// Sites for single cups of a tool of several; empty for a tool of one. Their quality is marked down, so that they come
/// after sites for the whole tool; where the part is a body of revolution one site stands for its whole circle.
std::vector<PickSite> find_one_cup_sites(const Part& part, const Gripper& gripper, const PickSiteConfig& config);

}  // namespace binpick

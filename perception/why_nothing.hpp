// A reason in words when an estimate comes back empty, for EstimateResult::message.
#pragma once

#include <string>
#include <vector>

#include "perception/part_search.hpp"
#include "perception/scene.hpp"

namespace binpick {

/// A part whose longest extent does not fit between walls, floor and headroom cannot be in the bin.
bool larger_than_bin(const PreparedPart& part, const Scene& scene, double headroom);

/// The first that holds: no depth at all, too little depth, nothing above the floor, no part fits the bin, and else
/// that no pose was likely enough.
std::string why_nothing(const Scene& scene, const std::vector<PreparedPart>& parts, double headroom);

}  // namespace binpick

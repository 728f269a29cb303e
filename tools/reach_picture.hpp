// A reach map as a picture: the bin from above, one panel for each height, green where every pose of the tool can be
// taken up, red where none can.
#pragma once

#include <string>

#include "core/image_io.hpp"
#include "robot/reach_map.hpp"

namespace binpick {

Image<Rgb> reach_picture(const ReachMap& map, const Cell& cell, const std::string& title);

/// The same in one or two lines of text, as `binpick check` prints them.
std::string reach_text(const ReachMap& map);

}  // namespace binpick

// Bins of our own as Open CASCADE solids, written as STEP. Millimetres; frame B: centre of the inner floor, z up. Only
// make_parts knows this.
#pragma once

#include <string>

namespace binpick {

/// Tote: 400 x 300 inside at the floor, 200 high, walls of 4 that lean outwards by 3 degrees, upright edges rounded to
/// 25, a rim of 14 x 5 around the top, and on each long wall two ribs 10 wide that stand 8 into the inside at the
/// floor, up to 160.
void write_tote_step(const std::string& path);

}  // namespace binpick

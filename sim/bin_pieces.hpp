// A bin from CAD as convex pieces, and the same thickened outwards. Frame B.
#pragma once

#include <vector>

#include "core/bin_spec.hpp"

namespace binpick {

/// Reads the mesh of a bin that has one and cuts it into convex pieces, kept on disk; nothing to do when it has none or
/// is prepared. Throws AssetError.
void prepare_bin(BinSpec& bin);

/// The pieces with what lies behind them as seen from inside: each that can be swept down or outwards by `thickness`
/// (m) without entering the room inside is, the way that fills most; ribs and dividers stay as thin as they are. No
/// fast part gets through.
std::vector<TriangleMesh> thickened(const std::vector<TriangleMesh>& pieces_B, const BinSpec& bin, double thickness);

}  // namespace binpick

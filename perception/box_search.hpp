// The open box that most patches of a view lie on. Patches vote for what is common (normals, the turn of upright
// patches, offsets along the axes), and every set of faces that this leaves is held against the view. Frame C, metres.
#pragma once

#include <vector>

#include "perception/open_box.hpp"

namespace binpick {

using Surfels = std::vector<Surfel>;

/// Directions that many patches face, most first.
std::vector<Eigen::Vector3d> common_normals(const Surfels& surfels);

/// The highest peaks of a histogram of offsets (m) that count at least `fewest`, highest first.
std::vector<double> offset_peaks(const std::vector<double>& values, double fewest);

/// Of four, three and two walls on a floor, in this order and roughly; what the view does not show is left out.
std::vector<OpenBox> likeliest_boxes(const Surfels& surfels, const StatedNoise& noise);

/// Puts the floor to the deepest clear mode of what faces up inside the walls: parts that lie flat are above it, and
/// what surrounds the bin, a few millimetres lower perhaps, is outside.
void settle_floor(OpenBox& box, const Surfels& surfels);

}  // namespace binpick

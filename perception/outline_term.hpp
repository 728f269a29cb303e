// Private to icp.cpp: how far the scene's depth steps lie from the drawn outline.
#pragma once

#include <vector>

#include "perception/part_view.hpp"
#include "perception/scene.hpp"

namespace binpick {

struct OutlineOffset {
  Eigen::Vector3f point_C;    ///< on the model's rim
  Eigen::Vector3f outward_C;  ///< unit, in the image plane
  float offset;               ///< m, the scene's rim lies this much further out (less the sensor's fattening)
};

/// Rim pixels at which the scene ends within `search` px: where it steps back or has no depth. Where something nearer
/// covers the rim, or the surface goes on, there is no offset.
std::vector<OutlineOffset> outline_offsets(const Scene& scene, const PartView& view, int search, float tolerance);

}  // namespace binpick

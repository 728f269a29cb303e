// Which views show a point of the model. Two points that no view shows together make a pair that no camera ever sees;
// in the table it only collects votes for wrong poses (Kim and Medioni 2011; Li and Hashimoto's MSV pairs). Frame P, m.
#pragma once

#include <cstdint>
#include <vector>

#include "core/point_cloud.hpp"
#include "perception/surface_model.hpp"

namespace binpick {

enum class Facing {
  kAlike,  ///< only surface that faces as the point's normal does
  kAny     ///< an edge point's direction lies in one face; it is seen when either of its faces is
};

/// Of every point the views that show it or the surface right beside it; all views where the surface has no point near.
std::vector<SurfaceModel::ViewMask> views_of(const PointCloud& cloud_P, const SurfaceModel& surface, Facing facing);

}  // namespace binpick

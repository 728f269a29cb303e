// One picture that tells how the testbed sees a part: its mesh with mass frame and symmetry axes, its convex pieces in
// colours, whole and drawn apart, and the poses in which it comes to rest. For people; it decides nothing.
#pragma once

#include <string>
#include <vector>

#include "core/image_io.hpp"
#include "core/part.hpp"
#include "core/stable_poses.hpp"
#include "sim/collision_shape.hpp"
#include "sim/depth_renderer.hpp"

namespace binpick {

struct PartSheet {
  const Part& part;
  const CollisionShape& shape;
  const std::vector<StablePose>& poses;
  std::vector<std::vector<std::string>> columns;  ///< lines of text under the pictures, the first is a heading
};

/// 1600 pixels wide, 1000 high.
Image<Rgb> part_sheet(const PartSheet& sheet, DepthRenderer& renderer);

/// Axes of a symmetry group in P: its main ones first.
struct SymmetryAxis {
  Eigen::Vector3d direction_P, point_P;
  int order = 2;  ///< turns of 2 pi / order; 0: any turn
};
std::vector<SymmetryAxis> symmetry_axes(const Symmetry& symmetry);

/// "sixths of a turn about (0 0 1)", "any turn about (0 0 1), and half turns across it": what the axes say.
std::string symmetry_in_words(const Symmetry& symmetry);

}  // namespace binpick

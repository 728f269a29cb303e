// What reaches the matching (paper 3.1): pass-through crop to the bin the cell believes in, known floor and walls taken
// away by geometry, normals, voxel grid at 0.04 of the part's diameter. Before the floor is cut, the floor itself shows
// how far the sensor's disparity is off in this frame, and that is removed. Frame C, metres.
#pragma once

#include "core/config.hpp"
#include "core/point_cloud.hpp"
#include "core/pose_estimate.hpp"
#include "perception/bin_localisation.hpp"
#include "perception/normals.hpp"
#include "perception/scene.hpp"

namespace binpick {

struct PreprocessConfig {
  double voxel = 0.04;             ///< of the diameter (paper 3.1)
  bool calibrate_floor = true;     ///< remove the disparity offset seen on the visible floor
  double largest_offset = 0.012;   ///< m at the floor, larger offsets are not believed
  double floor_cut = 3;            ///< standard deviations of the depth above the floor
  double floor_cut_least = 0.002;  ///< m
  bool thin_parts = true;         ///< parts thinner than six standard deviations: a neighbourhood tells floor from part
  bool find_bin = true;           ///< without a bin, the view itself shows one, or a table
  bool large_planes = true;       ///< where it does not, planes larger than any part are taken away
  double wall_margin = 0.005;     ///< m off the walls
  double headroom = 0.15;         ///< m above the walls' rim that is still looked at
  double near = 0.05, far = 3.0;  ///< m, depth range where there is no bin

  BinLocalisationConfig locate;  ///< the bin and the disparity's bias from floor and walls

  void visit(ConfigVisitor& v);
  void validate() const;
};

/// The scene with its wanted pixels and normals. `thinnest` (m): smallest extent of the wanted parts, so that the floor
/// is never cut higher than a part lying flat. `largest` (m): diameter of the largest of them; floor and walls of a bin
/// that has to be found reach farther, and with 0 none is looked for.
Scene make_scene(const SceneView& view, const PreprocessConfig& config, const NormalsConfig& normals, double thinnest,
                 double largest = 0);

/// One point a voxel and side: mean point and normal of the wanted pixels; what faces two ways in one voxel stays two
/// points. Only pixels with a normal count.
PointCloud voxel_grid(const Scene& scene, double voxel);
PointCloud voxel_grid(const PointCloud& cloud, double voxel);  ///< the same for a cloud with normals

}  // namespace binpick

// A flat plate with ArUco markers, its picture, its corners in an image, and its pose from them. Frame Q: centre of the
// plate, x to the right and y up as seen from its front, z out of it.
#pragma once

#include <optional>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/lens_distortion.hpp"
#include "core/pose.hpp"
#include "sim/surface_texture.hpp"

namespace binpick {

/// `rows` x `rows` markers of the dictionary 4x4_50, number 0 at the upper left, on a grid of `pitch`.
struct MarkerPlate {
  int rows = 2;
  double marker = 0.040;  ///< m, edge of the black square
  double pitch = 0.120;   ///< m, from centre to centre

  double edge() const;  ///< m, of the plate: markers and a white border of half a marker
  /// Four corners a marker in the order of OpenCV (from the upper left, clockwise as seen), marker after marker; m, in
  /// Q.
  std::vector<Eigen::Vector3d> corners_Q() const;
  SurfaceTexture texture() const;
};

struct SeenCorner {
  std::size_t index = 0;  ///< into corners_Q()
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// All four corners of every marker that OpenCV finds, refined to sub-pixels.
std::vector<SeenCorner> find_corners(const Image<std::uint8_t>& image, const MarkerPlate& plate);

/// The corners where camera and lens put them, those outside the image left out. `X_CQ` must lie before the camera.
std::vector<SeenCorner> projected_corners(const MarkerPlate& plate, const Pose& X_CQ, const PinholeCamera& camera,
                                          const LensDistortion& lens = {});

/// X_CQ with the least error in the image: of the two poses that a plane leaves open (IPPE; Collins, Bartoli 2014),
/// each refined, and of the iterative one, the one that fits best. Nothing with fewer than four corners.
std::optional<Pose> plate_pose(const std::vector<SeenCorner>& corners, const MarkerPlate& plate,
                               const PinholeCamera& camera, const LensDistortion& lens = {});

/// The same from a pose that is known nearly: the local optimum beside it.
Pose refined_plate_pose(const std::vector<SeenCorner>& corners, const MarkerPlate& plate, const PinholeCamera& camera,
                        const LensDistortion& lens, const Pose& X_CQ);

}  // namespace binpick

// An open box that a camera looks into: a floor and up to four walls, held against patches of the view. A ray that
// enters through the opening ends at floor or wall, unless something in the box stops it before; what is seen beyond
// them says that there is no such box. Frame H: axes of the box (z up), origin at the camera. Metres.
#pragma once

#include <array>
#include <span>

#include "perception/surfels.hpp"

namespace binpick {

constexpr int kBoxFaces = 5;  ///< floor, then the walls whose inner sides face +x, -x, +y, -y

struct OpenBox {
  Eigen::Matrix3d R_CH = Eigen::Matrix3d::Identity();
  double floor = 0;               ///< z of H, negative: the floor lies below the camera
  double height = 0;              ///< of the walls
  std::array<bool, 4> wall = {};  ///< is there one?
  std::array<bool, 4> edge = {};  ///< where none is: do the others end there? Then so does the box, at `offset`
  /// Inward normal . point, at the floor's height; negative: the camera is on the inner side.
  std::array<double, 4> offset = {};
  std::array<double, 4> slope = {};  ///< tangent of the draft angle, outwards

  int walls() const { return static_cast<int>(wall[0]) + wall[1] + wall[2] + wall[3]; }
  /// Face k is where normal(k) . q = level(k), q in H; inside is more.
  Eigen::Vector3d normal(int face) const;
  double level(int face) const { return face == 0 ? floor : offset[face - 1] + slope[face - 1] * floor; }
};

/// Where the ray of a patch leaves the box.
struct BoxRay {
  int face = -1;        ///< -1: the ray does not look into the box
  double distance = 0;  ///< of the patch from that face, inwards
  double aligned = 0;   ///< cosine between their normals
};
class BoxRays {
 public:
  explicit BoxRays(const OpenBox& box);
  BoxRay of(const Surfel& surfel) const;

 private:
  Eigen::Matrix3d R_HC_;
  std::array<Eigen::Vector3d, kBoxFaces> normal_;  ///< unit, in H
  std::array<double, kBoxFaces> level_;
  std::array<bool, kBoxFaces> face_, bound_;
  double rim_;
};

struct BoxSupport {
  std::array<int, kBoxFaces> rays = {}, on = {};  ///< that end on a face; of them, patches that lie there
  int beyond = 0;                                 ///< patches seen outside through floor or wall
  int inside() const { return rays[0] + rays[1] + rays[2] + rays[3] + rays[4]; }
  int all_on() const { return on[0] + on[1] + on[2] + on[3] + on[4]; }
};
BoxSupport support_of(const OpenBox& box, std::span<const Surfel> surfels, const StatedNoise& noise);

/// The box turned and its faces moved so that patches near them lie on them: robust least squares over one turn, an
/// offset a face and a draft a wall.
OpenBox fitted(OpenBox box, std::span<const Surfel> surfels, const StatedNoise& noise);

}  // namespace binpick

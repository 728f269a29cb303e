// Where the bin really stands, and how far the sensor's disparity is off, read off floor and walls in every frame. The
// believed pose may be wrong by some 5 mm and 1 degree; then the crop, the cut of the floor and the test against floor
// and walls would take parts away or leave the bin in. Frame C, metres; bias in inverse depth, 1/m:
//   1/z_seen = 1/z_true + b0 + b1 x + b2 y + b3 (x^2 + y^2),   x, y: pixel from the centre, over half the image's width
//
// Faces are looked at in cells. Of a cell's distances from the believed face the deepest clear mode counts (parts lie
// on the inner side), and a robust least-squares fit of pose and bias goes through the cells.
//
// What can be told apart and what cannot:
// - x, y and the turn about z come from the walls, the tilt from floor and walls.
// - On the floor alone a constant b0 and the bin's height are one and the same, and b1, b2 and a tilt: a tilted plane
// is
//   linear in inverse depth. Walls are parallel to the height, and seen obliquely: a wrong depth moves opposite walls
//   apart, and their true distance is known. So with walls in view b0 and height are told apart, to a few tenths of a
//   millimetre and no better; without them only the priors below decide.
// - Hence an assumption: a bin that stands where it is believed to in the ways that the walls show (x, y, turn) is
//   believed in the others as well, down to a thirtieth of the stated priors. A bin that is wrong in height alone
//   would, to that extent, be taken for a bias.
// - b3 bends the floor, which no pose does.
// - A ripple of the disparity is read off the walls where the camera states its f B (perception/disparity_ripple): the
//   floor shows one phase of it, parts above the floor have another. Left in the poses, 0.03 px at 0.6 m are 0.5 mm.
#pragma once

#include "core/config.hpp"
#include "perception/disparity_ripple.hpp"
#include "perception/scene.hpp"

namespace binpick {

struct BinLocalisationConfig {
  bool enabled = true;
  double position_sigma = 0.005;  ///< m, of the believed position, each axis (a bin put down by hand against a stop)
  double angle_sigma = 0.0175;    ///< rad, of the believed orientation, each axis (1 degree)
  double bias_sigma = 0.004;      ///< m at the floor, of b0 (D435: 0.2 px are 3.3 mm at 0.6 m)
  double tilt_sigma = 0.0005;     ///< m at the floor and the image's edge, of b1 and b2 (a calibrated pair)
  double bowl_sigma = 0.0005;     ///< m at the floor and the image's edge, of b3
  double ripple_sigma = 0.05;     ///< px, of a ripple of the disparity (measured 0.02 to 0.1); 0: none is looked for
  double reach = 0.02;            ///< m, distances from the believed faces that are looked at

  void visit(ConfigVisitor& v);
  void validate() const;
};

/// A disparity bias that may bend over the image.
struct InverseDepthBias {
  double constant = 0, along_x = 0, along_y = 0, bowl = 0;  ///< 1/m
  double at(const PinholeCamera& camera, double u, double v) const {
    const double half = camera.width / 2.0, x = (u - camera.cx) / half, y = (v - camera.cy) / half;
    return constant + along_x * x + along_y * y + bowl * (x * x + y * y);
  }
};

struct LocatedBin {
  Pose X_CB = Pose::Identity();
  InverseDepthBias bias;
  DisparityRipple ripple;
  int floor_cells = 0, wall_cells = 0;  ///< that the fit rests on
  bool found = false;                   ///< false: too little of the bin is seen, pose as believed and no bias
};

/// Needs scene.bin; scene.depth as seen, not yet corrected.
LocatedBin locate_bin(const Scene& scene, const BinLocalisationConfig& config);

}  // namespace binpick

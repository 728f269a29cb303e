// A stereo matcher pulls its disparities towards whole pixels (or half ones): an error that runs through a wave with
// every pixel of disparity. Floor and flat parts each show one phase of it only, so that a correction read off the
// floor is wrong for parts above it; walls run through a dozen waves from floor to rim, which tells the wave from any
// pose of the bin. Seen disparity d = f B / z:
//   d_seen = d_true + sine sin(2 pi d_seen) + cosine cos(2 pi d_seen)
// In the seen disparity, so that it can be taken out at once; a bias of the disparity then only turns the phase.
#pragma once

#include <cmath>
#include <numbers>
#include <span>

namespace binpick {

struct DisparityRipple {
  double fB = 0;                ///< m px
  double sine = 0, cosine = 0;  ///< px

  bool none() const { return sine == 0 && cosine == 0; }
  /// 1/z_seen - 1/z_true, 1/m.
  double at(double z) const {
    if (none()) return 0;
    const double turns = fB / z, angle = 2 * std::numbers::pi * (turns - std::floor(turns));
    return (sine * std::sin(angle) + cosine * std::cos(angle)) / fB;
  }
};

/// A point seen on a face that the wave is read off.
struct RippleSample {
  int face = 0;
  double disparity = 0;  ///< px, as seen
  double off = 0;        ///< px, seen disparity minus the face's
  double sigma = 0;      ///< px
};

/// Least squares, robust, beside a level and a slope in the disparity of each face (0 .. faces - 1): what a face's pose
/// may be off by is not a wave. `amplitude_sigma`: px, of either coefficient, before anything is seen.
DisparityRipple fit_ripple(std::span<const RippleSample> samples, int faces, double fB, double amplitude_sigma);

}  // namespace binpick

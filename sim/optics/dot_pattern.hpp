// The pseudo-random dots of an active stereo projector: one jittered dot in most cells of a square grid over the
// tangent plane of D, each a Gaussian spot, drawn once into a fine image (several texels for each spot radius, so that
// reading it between texels does not alias). The same seed is the same optical element.
#pragma once

#include "core/image.hpp"
#include "core/random.hpp"

namespace binpick {

struct DotPatternConfig {
  double pitch = 0.01;     ///< rad, side of a cell
  double radius = 0.0024;  ///< rad, standard deviation of a spot
  double density = 0.7;    ///< probability that a cell holds a dot
  double half_x = 1.2349;  ///< tangent of half the horizontal field of view
  double half_y = 0.7;     ///< and of the vertical one
};

class DotPattern {
 public:
  DotPattern(const DotPatternConfig& config, Seed seed);
  /// Brightness at the direction (x, y, 1) of D; 0 outside the field of view.
  double at(double x, double y) const;

 private:
  void add_spot(double x, double y, double brightness);

  DotPatternConfig config_;
  double texel_;
  Image<float> image_;
};

}  // namespace binpick

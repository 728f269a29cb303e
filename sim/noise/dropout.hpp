// Pixels that give no return: grazing surfaces, too little or too much light, and holes at random (physical_models
// A3.3). No public number exists for dropout on machined metal: report results over a sweep of these, not as the truth.
#pragma once

#include "core/random.hpp"
#include "sim/noise/disparity_image.hpp"

namespace binpick {

struct Dropout {
  double grazing_angle = 1.3089969389957472;   ///< rad (75 deg): half of such pixels are lost
  double grazing_width = 0.05235987755982988;  ///< rad (3 deg): of the logistic around it
  double lobe = 0;            ///< mirror-like return of a surface seen head on, in units of albedo / m^2
  double lobe_exponent = 60;  ///< the lobe falls as cos^n of the incidence angle
  double return_low = 0.02;   ///< 1/m^2: weaker returns are lost
  double return_high = 1e3;   ///< 1/m^2: stronger returns saturate and are lost
};

/// Removes lost pixels. The return of a surface is I = albedo cos t / z^2 + lobe cos^n t.
void drop_returns(const StereoView& view, const Dropout& dropout, const Rng& rng, DisparityImage& image);

/// Removes each pixel with the given probability.
void drop_speckles(double probability, const Rng& rng, int threads, DisparityImage& image);

}  // namespace binpick

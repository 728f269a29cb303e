// A Gaussian random field of mean 0 and variance 1 with a Gaussian correlation: white noise filtered by a Gaussian and
// renormalised (physical_models A3.3). Its autocorrelation at lag k is exp(-k^2 / (4 length^2)).
#pragma once

#include "core/image.hpp"
#include "core/random.hpp"

namespace binpick {

struct CorrelatedField {
  double length = 2.5;       ///< px, standard deviation of the filter; 0: white
  double fixed_share = 0.5;  ///< of the variance, drawn from `fixed` and so the same in every frame
};

/// No border: the noise is drawn on a larger grid. A value depends only on its place, not on the order of drawing.
Image<float> correlated_field(int width, int height, const CorrelatedField& field, const Rng& fixed,
                              const Rng& changing, int threads = 1);

}  // namespace binpick

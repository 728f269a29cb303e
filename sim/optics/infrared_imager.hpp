// From radiance to the 8-bit image of an infrared imager: lens blur, exposure, speckle of the laser light, thermal
// noise, saturation (physical_models A1).
#pragma once

#include <cstdint>

#include "core/image.hpp"
#include "core/random.hpp"

namespace binpick {

struct InfraredNoise {
  double speckle_shape = 398.12;  ///< k of a Gamma(k, 1/k) factor on the light; 0: none
  double fixed_share = 0.5;       ///< of the speckle's variance, the same in every frame
  double thermal = 0.83;          ///< grey levels, standard deviation
};

/// Blur by (w, 1 - 2w, w) along both directions: a lens of standard deviation sqrt(2 w) px.
void blur(Image<float>& image, double w);

/// The gain (grey levels per unit of radiance) at which the mean of the saturated image is `mean_grey`, at most
/// `max_gain`.
double exposure_for_mean(const Image<float>& radiance, double mean_grey, double max_gain);

/// The streams are drawn by pixel: no value depends on another. `fixed` is the unit's own, `changing` the frame's.
Image<std::uint8_t> expose(const Image<float>& radiance, double gain, const InfraredNoise& noise, const Rng& fixed,
                           const Rng& changing, int threads);

}  // namespace binpick

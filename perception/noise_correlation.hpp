// How far the noise of neighbouring pixels agrees, measured on the frame itself: matching windows of a stereo camera
// give whole patches the same error, which no averaging within the patch removes. Pixels.
#pragma once

#include "perception/scene.hpp"

namespace binpick {

/// Needs the normals. Pixels that share one noise value; 1 for noise that differs from pixel to pixel, and where too
/// little is seen. From the spread of second differences along rows at a short and a long lag k on flat pieces (which
/// the planes themselves do not enter):
///   E (z(u-k) - 2 z(u) + z(u+k))^2 = sigma^2 (6 - 8 r(k) + 2 r(2k)),   r(k) = exp(-k^2 / (4 s^2))
/// The noise is as good as white noise through a Gaussian of deviation s; a part then holds one value every 4 pi s^2.
double pixels_per_noise_value(const Scene& scene);

}  // namespace binpick

// How good is a depth image of a heap, beside the exact frame of the same look? For comparing sensors where no wall can
// be fitted. Robust figures: a few gross errors at outlines do not decide them, they are counted apart.
#pragma once

#include "sim/depth_renderer.hpp"

namespace binpick {

struct HeapQuality {
  std::size_t pixels = 0;          ///< that show what is asked for in the exact frame
  double fill = 0;                 ///< share of them with a return
  double bias = 0;                 ///< m, median of z - z_true
  double sigma = 0;                ///< m, 1.4826 x median of |z - z_true - bias|
  double inverse_depth_noise = 0;  ///< 1/m, the same of 1/z; times f B it is the subpixel noise in px
  double gross = 0;                ///< share of the returns off by more than kGross
};
inline constexpr double kGross = 5e-3;  // m

/// Over the pixels of parts, or over everything else that is seen. NaN where nothing can be told.
HeapQuality heap_quality(const Image<float>& depth, const ExactFrame& exact, bool parts);

/// Median length in px of the run of lost pixels on the left of a foreground that stands kShadowStep or more before
/// what is behind it: there w = f B (1/z_near - 1/z_far) is lost to a second imager (physical_models A1).
double shadow_width(const Image<float>& depth, const ExactFrame& exact);
inline constexpr double kShadowStep = 0.1;  // m: rims of a bin, not parts on parts

}  // namespace binpick

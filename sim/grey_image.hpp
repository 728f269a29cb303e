// The 8-bit image of a grey (monochrome) camera: calibration markers, pictures for image-based programs. In this order:
//   1. every sample (supersampling^2 a pixel) asks the lens for its direction, the exact frame for what is there
//   2. shading: one lamp with hard shadows, evenly bright over the cell, plus light from all around; Lambert and one
//      lobe by the item's material (sim/optics/reflectance); a texture's reflectance is averaged over the sample's area
//   3. blur of the lens: a Gaussian over the samples, then their mean over the pixel
//   4. exposure: a white matt surface that faces the lamp comes out at `white` grey levels
//   5. shot noise (variance = electrons) and read noise, one normal draw a pixel, then whole grey levels 0 .. 255
// Linear: no gamma. It follows the linear camera model of EMVA 1288 (without dark current, fixed pattern or
// vignetting). It cannot show: light that bounces between parts, mirrors, motion blur, depth of focus, colour.
//
// | key           | default | unit | meaning and source
// | ------------- | ------- | ---- | ------------------------------------------------------------------------
// | supersampling | 3       |      | samples a side of one pixel
// | blur          | 0.6     | px   | standard deviation; a good lens at its best aperture (untuned)
// | ambient       | 0.35    |      | share of the light that comes from all around (untuned)
// | white         | 220     | grey | see 4
// | full_well     | 10000   | e-   | electrons at grey level 255; small global-shutter CMOS pixels hold about as many
// | read_noise    | 4       | e-   | standard deviation; such sensors' sheets state 2 .. 7
#pragma once

#include <cstdint>

#include "core/camera.hpp"
#include "core/config.hpp"
#include "core/image.hpp"
#include "core/lens_distortion.hpp"
#include "core/random.hpp"
#include "sim/depth_renderer.hpp"

namespace binpick {

struct GreyConfig {
  int supersampling = 3;
  double blur = 0.6;         ///< px
  double ambient = 0.35;     ///< 0 .. 1
  double white = 220;        ///< grey levels
  double full_well = 10000;  ///< e-
  double read_noise = 4;     ///< e-
  void visit(ConfigVisitor& v);
  void validate() const;
};

struct GreyCamera {
  PinholeCamera intrinsics;
  LensDistortion lens;
  Pose X_WC = Pose::Identity();
};

/// Steps 1 to 3: light on each pixel, 1 for a white matt surface that faces the lamp. 0 where nothing is.
Image<float> grey_light(DepthRenderer& renderer, const RenderScene& scene, const GreyCamera& camera,
                        const GreyConfig& config);

/// Steps 4 and 5. The stream is drawn by pixel: no value depends on another.
Image<std::uint8_t> expose_grey(const Image<float>& light, const GreyConfig& config, Seed frame_seed);

/// All five.
Image<std::uint8_t> capture_grey(DepthRenderer& renderer, const RenderScene& scene, const GreyCamera& camera,
                                 const GreyConfig& config, Seed frame_seed);

}  // namespace binpick

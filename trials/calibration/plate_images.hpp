// Grey images of a marker plate as a camera of a calibration takes them: the plate alone, by the shared renderer, with
// the sensor's own noise. What corner noise is then is nobody's choice but the image's. Frames: C the camera, Q the
// plate.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/grey_image.hpp"
#include "trials/calibration/marker_plate.hpp"

namespace binpick {

class PlateImages {
 public:
  /// `renderer`: a name of renderer_names().
  explicit PlateImages(const MarkerPlate& plate, const std::string& renderer = "osmesa");
  ~PlateImages();

  Image<std::uint8_t> image(const Pose& X_CQ, const PinholeCamera& camera, Seed seed) const;
  /// The corners that OpenCV finds in it.
  std::vector<SeenCorner> corners(const Pose& X_CQ, const PinholeCamera& camera, Seed seed) const;

 private:
  MarkerPlate plate_;
  std::unique_ptr<DepthRenderer> renderer_;
  RenderItem item_;
};

}  // namespace binpick

// What `binpick render` leaves behind: one look as files for people and other programs (docs/render_folder.md).
#pragma once

#include <cstdint>
#include <string>

#include "sim/depth_sensor.hpp"
#include "trials/cell_world.hpp"
#include "trials/scenario.hpp"

namespace binpick {

struct RenderLabels {
  std::string scenario_hash;
  std::uint64_t seed = 0;
  bool settled = true;
  Pose X_WC_true = Pose::Identity();  ///< of the camera, for its picture
};

/// depth_mm.png, depth.tiff, ids.png, noise.png, preview.png, shaded.png, cloud.ply and render.yaml in `folder`, which
/// is made. Throws StorageError.
void write_render_folder(const std::string& folder, const Scenario& scenario, const RenderLabels& labels,
                         const Capture& capture, const CellWorld& cell_world, DepthRenderer& renderer);

/// Metres per count of the 16-bit depth image: 0.1 mm, or the next of 0.2, 0.5, 1 .. mm that reaches the farthest
/// depth.
double depth_png_step(const Image<float>& depth);
/// Depth in counts of `step`, 0 where there is none.
Image<std::uint16_t> depth_counts(const Image<float>& depth, double step);
/// Labels for a 16-bit image: 0 nothing, 1 + heap index for a part, ids from kIdBin on for the cell.
Image<std::uint16_t> label_counts(const Image<std::int32_t>& ids);

}  // namespace binpick

#include "trials/oracle_stages.hpp"

#include <limits>

#include "sim/render_scene.hpp"

namespace binpick {

std::shared_ptr<const Image<std::uint8_t>> true_segmentation(const Observation& seen) {
  const Image<std::int32_t>& ids = seen.captures.front().exact.ids;
  auto parts = std::make_shared<Image<std::uint8_t>>(ids.width(), ids.height(), std::uint8_t{0});
  for (std::size_t i = 0; i < ids.size(); ++i) (*parts)[i] = ids[i] >= 0 && ids[i] < kIdBin;
  return parts;
}

TrueSight true_sight(const Observation& seen, const EstimateResult& found) {
  const Capture& capture = seen.captures.back();
  TrueSight sight{seen.view, found, seen.truth.X_WC};
  DepthFrame frame = capture.frame;
  frame.depth = capture.exact.depth;
  frame.X_WC = sight.X_WC;
  frame.noise = {};
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const std::int32_t id = capture.exact.ids[i];
    if (id == kIdArm || id == kIdTool) frame.depth[i] = std::numeric_limits<float>::quiet_NaN();
  }
  sight.view.seen = frame;
  const Pose X_TC = sight.X_WC.inverse() * seen.X_WC_believed;  // T: where the camera truly stands
  sight.view.X_CB = X_TC * seen.view.X_CB;
  for (PoseEstimate& e : sight.found.estimates) e.X_CP = X_TC * e.X_CP;
  return sight;
}

void seal_what_touches(const CellWorld& cell, std::span<const SurfaceSample> samples, Contact& contact) {
  const std::size_t each = samples.size() / contact.cup_sealed.size();
  contact.sealed = false;
  for (std::size_t c = 0; c < contact.cup_sealed.size(); ++c) {
    const SurfaceSample& first = samples[c * each];
    const CupSpec& cup = cell.cell().gripper->cups()[c];
    std::size_t touching = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = c * each; k < (c + 1) * each; ++k) {
      if (!samples[k].hit || samples[k].body != first.body) continue;
      ++touching;
      nearest = std::min(nearest, (cup.X_GU.inverse() * samples[k].point_G).z());
    }
    const bool touches = 2 * touching > each && nearest <= cup.lip_compliance && cell.heap_index_of(first.body);
    contact.cup_sealed[c] = touches;
    contact.cup_vacuum[c] = touches ? 1 : 0;
    contact.why[c] = touches ? "" : "touches no part";
    contact.sealed = contact.sealed || touches;
  }
}

}  // namespace binpick

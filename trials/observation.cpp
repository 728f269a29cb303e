#include "trials/observation.hpp"

namespace binpick {
namespace {

std::vector<DropItem> drop_order(const Scenario& s, const TrialContext& context, Seed seed) {
  std::vector<DropItem> items;
  for (std::size_t p = 0; p < s.parts.size(); ++p)
    for (int k = 0; k < s.parts[p].count; ++k) items.push_back({&context.parts[p], &context.shapes[p], p});
  seed.child("order").rng().shuffle(items);
  return items;
}

// What was true when the frame was taken; instances in the tray or on the table are not part of the question.
GroundTruth truth_of(const CellWorld& cell_world, const Capture& capture, const Pose& X_WC) {
  GroundTruth truth;
  truth.X_WC = X_WC;
  const DropResult& heap = cell_world.heap();
  for (std::size_t i = 0; i < heap.bodies.size(); ++i) {
    if (!cell_world.in_bin(i)) continue;
    const Visibility& visibility = capture.visibility[i];
    truth.instances.push_back(
        {heap.parts[i], i, cell_world.world().pose(heap.bodies[i]), visibility.fraction(), visibility.visible_pixels});
  }
  return truth;
}

}  // namespace

DropResult drop_heap(const Scenario& s, const TrialContext& context, Seed trial_seed, CellWorld& cell_world) {
  const Seed seed = trial_seed.child("drop");
  const DropResult heap =
      drop_parts(cell_world.world(), drop_order(s, context, seed), s.cell.bin, s.cell.X_WB, s.drop, s.settle, seed);
  cell_world.set_heap(heap);
  return heap;
}

Observation observe(const Scenario& s, const CellWorld& cell_world, TrialContext& context, Seed trial_seed, int pick) {
  const Pose X_WC = s.cell.camera_pose(cell_world.joints());
  Observation seen;
  seen.captures.push_back(capture_depth(*context.renderer, *s.sensor, cell_world.render_scene(),
                                        cell_world.heap().bodies.size(), s.cell.camera.intrinsics, X_WC, X_WC,
                                        trial_seed.child("camera"),
                                        trial_seed.child("sensor", static_cast<std::uint64_t>(pick))));
  const Capture& capture = seen.captures.front();
  seen.frame_hash = frame_hash(capture.frame);
  seen.X_WC_believed = capture.frame.X_WC;
  seen.truth = truth_of(cell_world, capture, X_WC);
  seen.view.seen = capture.frame;
  seen.view.bin = s.cell.bin;
  seen.view.X_CB = capture.frame.X_WC.inverse() * s.cell.X_WB;
  return seen;
}

}  // namespace binpick

#include "trials/observation.hpp"

#include "core/hash.hpp"
#include "perception/fuse_frames.hpp"

namespace binpick {
namespace {

// What was true when the frames were taken; instances in the tray or on the table are not part of the question. An
// instance counts as visible as it is to the camera that sees it best.
GroundTruth truth_of(const CellWorld& cell_world, const std::vector<Capture>& captures, const Pose& X_WC) {
  GroundTruth truth;
  truth.X_WC = X_WC;
  const DropResult& heap = cell_world.heap();
  for (std::size_t i = 0; i < heap.bodies.size(); ++i) {
    if (!cell_world.in_bin(i)) continue;
    Visibility best = captures.front().visibility[i];
    for (const Capture& capture : captures)
      if (capture.visibility[i].fraction() > best.fraction()) best = capture.visibility[i];
    truth.instances.push_back(
        {heap.parts[i], i, cell_world.world().pose(heap.bodies[i]), best.fraction(), best.visible_pixels});
  }
  return truth;
}

/// One camera: its frame's hash. Several: over all of them, in order.
std::uint64_t hash_of(const std::vector<DepthFrame>& frames) {
  if (frames.size() == 1) return frame_hash(frames.front());
  Hasher hasher;
  for (const DepthFrame& frame : frames) hasher.add(frame_hash(frame)).add(frame.X_WC);
  return hasher.value();
}

}  // namespace

TrueCell true_cell(const Scenario& s, const TrialContext& context, Seed trial_seed) {
  TrueCell built{s.cell, std::nullopt};
  if (s.calibration.perfect()) return built;
  built.X_CC = calibration_offset(s.calibration, context.calibration.get(), trial_seed);
  built.cell.camera.pose = orthonormalised(s.cell.camera.pose * built.X_CC->inverse());
  return built;
}

std::vector<DropItem> drop_order(const Scenario& s, const TrialContext& context, Seed seed) {
  std::vector<DropItem> items;
  for (std::size_t p = 0; p < s.parts.size(); ++p)
    for (int k = 0; k < context.counts[p]; ++k) items.push_back({&context.parts[p], &context.shapes[p], p});
  seed.child("order").rng().shuffle(items);
  return items;
}

DropResult drop_heap(const Scenario& s, const TrialContext& context, Seed trial_seed, CellWorld& cell_world) {
  const Seed seed = trial_seed.child("drop");
  DropResult heap =
      drop_parts(cell_world.world(), drop_order(s, context, seed), s.cell.bin, s.cell.X_WB, s.drop, s.settle, seed);
  check_rest(cell_world.world(), s.cell.bin, s.cell.X_WB, context.probes, s.settle, heap);
  cell_world.set_heap(heap);
  return heap;
}

Capture capture_again(const Scenario& s, const CellWorld& cell_world, TrialContext& context, Seed trial_seed,
                      int pick) {
  const Pose X_WC_true = cell_world.cell().camera_pose(cell_world.joints());
  const Pose X_WC_believed = s.cell.camera_pose(cell_world.joints());
  const Seed frame_seed = trial_seed.child("sensor", static_cast<std::uint64_t>(pick)).child("second look");
  return capture_depth(*context.renderer, *s.sensor, cell_world.render_scene(), cell_world.heap().bodies.size(),
                       s.cell.camera.intrinsics, X_WC_true, X_WC_believed, trial_seed.child("camera", 0), frame_seed);
}

Observation observe(const Scenario& s, const CellWorld& cell_world, TrialContext& context, Seed trial_seed, int pick) {
  const RenderScene scene = cell_world.render_scene();
  Observation seen;
  std::vector<DepthFrame> frames;
  for (std::size_t k = 0; k < s.cell.camera_count(); ++k) {
    const Pose X_WC_true = cell_world.cell().camera_pose(cell_world.joints(), k);
    const Pose X_WC_believed = s.cell.camera_pose(cell_world.joints(), k);
    Seed frame_seed = trial_seed.child("sensor", static_cast<std::uint64_t>(pick));
    if (k > 0) frame_seed = frame_seed.child("camera", k);
    seen.captures.push_back(capture_depth(*context.renderer, *s.sensor, scene, cell_world.heap().bodies.size(),
                                          s.cell.camera_at(k).intrinsics, X_WC_true, X_WC_believed,
                                          trial_seed.child("camera", k), frame_seed));
    frames.push_back(seen.captures.back().frame);
  }
  seen.frame_hash = hash_of(frames);
  seen.X_WC_believed = frames.front().X_WC;
  seen.truth = truth_of(cell_world, seen.captures, cell_world.cell().camera_pose(cell_world.joints()));
  if (frames.size() == 1) {
    seen.view.seen = frames.front();
  } else {
    seen.view.seen = fuse_frames(frames, {}, KnownBin{s.cell.bin, s.cell.X_WB});
    seen.view.cloud_noise = frames.front().noise;
  }
  seen.view.bin = s.cell.bin;
  // As a recorded frame holds it, so that the frame read back is the same input to the last bit.
  const Pose X_CB = seen.X_WC_believed.inverse() * s.cell.X_WB;
  seen.view.X_CB = pose_from_xyz_rpy(X_CB.translation(), stored_rpy(X_CB.linear()));
  return seen;
}

}  // namespace binpick

// Watches a trial and keeps what a replay shows. It reads and never writes: a trial's record has the same bits with it
// and without (tests/trials/replay_test.cpp).
#pragma once

#include <memory>

#include "sim/step_watch.hpp"
#include "trials/replay.hpp"
#include "trials/sight.hpp"

namespace binpick {

class ReplayRecorder {
 public:
  /// Points kept of the cloud of every look.
  explicit ReplayRecorder(std::size_t points = 2000) : points_(points) {}

  /// From now on every step is watched, as long as the result lives: not longer than `cell_world`.
  std::unique_ptr<StepWatch> watch(CellWorld& cell_world);
  /// The heap is at rest and the arm has come.
  void heap_at_rest(const CellWorld& cell_world);
  /// What a look led to, before the arm moves; `record` holds the check against the truth.
  void look(int pick, const CellWorld& cell_world, const Sight& sight, const PickRecord& record);
  void event(int pick, const CellWorld& cell_world, const std::string& what);
  /// The trial is over.
  Replay finish(const TrialRecord& record);

 private:
  void sample(const CellWorld& cell_world);
  std::size_t points_;
  double next_sample_ = 0;
  bool arm_here_ = false;
  std::vector<PoseTrack> by_body_;   ///< by BodyId; empty for what is no part
  std::vector<BodyId> heap_bodies_;  ///< by heap index
  Replay replay_;
};

}  // namespace binpick

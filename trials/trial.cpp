#include "trials/trial.hpp"

#include <chrono>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "evaluation/statistics.hpp"
#include "trials/oracle_stages.hpp"
#include "trials/second_look.hpp"

namespace binpick {
namespace {

// Wall time: reported beside the result, never part of it.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::uint64_t estimates_hash(const EstimateResult& found) {
  Hasher hasher;
  for (const PoseEstimate& e : found.estimates)
    hasher.add(std::uint64_t{e.part}).add(e.X_CP).add(e.score).add(e.fit_rms).add(e.inlier_fraction);
  return hasher.value();
}

bool chosen_is_right(const PickRecord& record, std::size_t chosen) {
  for (const MatchedEstimate& match : record.check.estimates)
    if (match.estimate == chosen) return match.right;
  return false;
}

// What stays with a trial from pick to pick.
struct Run {
  const Scenario& s;
  CellWorld& cell_world;
  TrialContext& context;
  Seed seed;
  TrialPictures* pictures;
  ReplayRecorder* replay;
  std::vector<Eigen::Vector3d> failed_W;  // middles of believed parts at which picks have failed since the last success
  std::vector<Eigen::Vector3d> ever_failed_W;  // and since the first look: whoever succeeds elsewhere forgets nothing
  std::vector<PlacedPart> in_tray;             // parts that succeeded, where the robot let go of them
};

void execute(Run& run, const PickPlan& plan, int pick, PickRecord& record) {
  const ExecutionHook hook = [&](const char* moment, const CellWorld& now) {
    if (run.pictures) run.pictures->moment(pick, moment, *run.context.renderer, now);
    if (run.replay) run.replay->event(pick, now, moment);
  };
  ExecutionConfig config = run.s.execution;
  config.ideal_seal = run.s.oracles.seal;
  const ExecutionResult result = execute_pick(run.cell_world, plan, config, hook);
  record.outcome = result.outcome;
  record.reason = result.reason;
  record.lifted_body = result.lifted;
  record.motion_time += result.motion_time;  // beside that of a second look
  record.sim_time += result.motion_time + result.vacuum_time;
  record.place_error = result.place_error;
  record.place_rotation = result.place_rotation;
  record.hold_use = result.hold_use;
  record.contact_force = result.contact_force;
  record.contact_depth = result.contact_depth;
  record.contact = result.contact;
  add_collisions(result.collisions, result.collision_depth, record);
  record.neighbours_dragged = result.neighbours_dragged;
  record.parts_dropped_back = result.parts_dropped_back;
  record.parts_lost = result.parts_lost;
  record.swing = result.swing;
  record.peak_force = result.peak_force;
  record.neighbours_moved = result.neighbours_moved;
}

int count_in(const CellWorld& cell_world, bool (CellWorld::*where)(std::size_t) const) {
  int count = 0;
  for (std::size_t i = 0; i < cell_world.heap().bodies.size(); ++i) count += (cell_world.*where)(i) ? 1 : 0;
  return count;
}

FrameRequest frame_request(const Scenario& s, Seed seed) {
  FrameRequest request;
  for (const PartEntry& entry : s.parts) request.parts.push_back(entry.spec);
  request.seed = seed;
  request.estimator_type = s.estimator_type;
  request.estimator = s.estimator;
  return request;
}

// The arm moves: what comes of it.
void execute_plan(Run& run, const PickPlan& plan, int pick, PickRecord& record) {
  record.chosen = plan.estimate;
  if (run.s.trial.execute == "only_if_right" && !chosen_is_right(record, plan.estimate)) {
    record.outcome = PickOutcome::kNoReachablePick;
    record.reason = "not executed: the chosen estimate is wrong (trial.execute: only_if_right)";
    return;
  }
  execute(run, plan, pick, record);
}

// What lay in the bin: for recall by visibility and by depth in the heap.
void note_seen(const Run& run, const GroundTruth& truth, PickRecord& record) {
  const Pose X_BW = run.s.cell.X_WB.inverse();
  for (const GroundTruth::Instance& instance : truth.instances) {
    const Part& part = run.context.parts[instance.part];
    const double height = (X_BW * instance.X_WP * part.box_center_P).z();
    record.seen.push_back({static_cast<int>(instance.part), part.diameter, instance.visible_fraction, height});
  }
}

// What was seen and found, told the record before the arm moves for the pick.
void note_sight(const Run& run, const Sight& sight, PickRecord& record) {
  record.frame_hash = sight.seen.frame_hash;
  record.wall = sight.found.wall;
  record.estimates_hash = estimates_hash(sight.found);
  record.check = run.context.checker->check(sight.found, sight.seen.X_WC_believed, sight.seen.truth);
  note_seen(run, sight.seen.truth, record);
  record.rejections = sight.plan.rejections;
  record.outcome = sight.plan.outcome;
  record.reason = sight.plan.reason;
  if (sight.found.status == EstimateStatus::kFound) return;
  const bool failed = sight.found.status == EstimateStatus::kFailed;
  record.outcome = failed ? PickOutcome::kEstimatorFailed : PickOutcome::kNoDetection;
  record.reason = failed ? sight.found.message : "the estimator found nothing";
}

// One turn of the loop: look (twice if need be), estimate, check, plan, pick.
PickRecord pick_once(Run& run, int pick) {
  PickRecord record;
  record.sim_time = run.s.trial.exposure;
  const PickStart start{count_in(run.cell_world, &CellWorld::in_tray), run.failed_W, {}, run.in_tray};
  const Seed estimator_seed = run.seed.child("estimator", static_cast<std::uint64_t>(pick));
  Sight sight;
  sight.seen = observe(run.s, run.cell_world, run.context, run.seed, pick);
  if (run.s.oracles.segmentation) sight.seen.view.segmentation = true_segmentation(sight.seen);
  sight.found = estimate_view(run.s, run.context, sight.seen.view, sight.seen.truth, estimator_seed);
  plan_sight(run.s, run.context, start, sight, record);
  if (run.pictures) {
    run.pictures->look(pick, "", *run.context.renderer, run.cell_world, sight.seen.captures[0].frame, sight.found);
    if (run.s.estimator) run.pictures->frame(pick, frame_request(run.s, estimator_seed), sight.seen.view, sight.found);
  }
  const LookRun look{run.s, run.cell_world, run.context, run.seed, pick, start, run.ever_failed_W};
  const bool looked_again = look_again(look, sight, record);
  if (looked_again && run.pictures)
    run.pictures->look(pick, "second_", *run.context.renderer, run.cell_world, sight.seen.captures.back().frame,
                       sight.found);
  note_sight(run, sight, record);
  if (run.replay) run.replay->look(pick, run.cell_world, sight, record);
  if (sight.plan.plan) {
    execute_plan(run, *sight.plan.plan, pick, record);
    const Part& part = run.context.parts[sight.found.estimates[sight.plan.plan->estimate].part];
    const Eigen::Vector3d middle_W = sight.plan.plan->X_WP_est * part.box_center_P;
    run.failed_W.push_back(middle_W);
    if (record.outcome != PickOutcome::kSucceeded) run.ever_failed_W.push_back(middle_W);
    if (record.outcome == PickOutcome::kSucceeded)
      run.in_tray.push_back({sight.found.estimates[sight.plan.plan->estimate].part, sight.plan.plan->X_WP_place});
  }
  const double away = (run.cell_world.joints() - run.s.cell.q_look).cwiseAbs().maxCoeff();
  if (away > 1e-6) return_home(look, record);  // nothing was picked from where the second look was taken
  return record;
}

void pick_until_done(Run& run, TrialRecord& record) {
  int failures = 0;
  for (int pick = 0; pick < run.s.trial.max_picks && failures < run.s.trial.failures_in_a_row; ++pick) {
    if (count_in(run.cell_world, &CellWorld::in_bin) == 0) break;
    record.picks.push_back(pick_once(run, pick));
    record.picks.back().world_hash = run.cell_world.world().state_hash();
    const bool succeeded = record.picks.back().outcome == PickOutcome::kSucceeded;
    failures = succeeded ? 0 : failures + 1;
    if (succeeded) run.failed_W.clear();
    if (run.replay) run.replay->event(pick, run.cell_world, to_string(record.picks.back().outcome));
    if (!succeeded && run.pictures) run.pictures->moment(pick, "failed", *run.context.renderer, run.cell_world);
  }
  record.placed = count_in(run.cell_world, &CellWorld::in_tray);
}

struct Onlookers {
  TrialPictures* pictures;
  ReplayRecorder* replay;
};

void run(const Scenario& s, Seed seed, TrialContext& context, const Onlookers& onlookers, TrialRecord& record) {
  const TrueCell built = true_cell(s, context, seed);
  if (built.X_CC) {
    record.calibration_translation = built.X_CC->translation();
    record.calibration_rotation = log_so3(built.X_CC->linear());
  }
  CellWorld cell_world(built.cell, s.physics, context.parts);
  ReplayRecorder* replay = onlookers.replay;
  const std::unique_ptr<StepWatch> watch = replay ? replay->watch(cell_world) : nullptr;
  const DropResult heap = drop_heap(s, context, seed, cell_world);
  if (replay) replay->heap_at_rest(cell_world);
  record.dropped = static_cast<int>(heap.bodies.size());
  record.escaped = static_cast<int>(heap.escaped.size());
  record.settled = heap.settled;
  record.settle_time = heap.settle_time;
  record.worst_penetration = heap.worst_penetration;
  if (!heap.penetrations.empty()) {
    record.penetration_p99 = quantile(heap.penetrations, 0.99);
    record.penetration_max = quantile(heap.penetrations, 1);
  }
  record.woken_energy = heap.woken.energy;
  record.woken_motion = heap.woken.largest_motion;
  record.woken_share = heap.woken.moved_share;
  record.drop_hash = cell_world.world().state_hash();
  if (heap.settled && heap.escaped.empty()) {
    Run run_state{s, cell_world, context, seed, onlookers.pictures, replay, {}, {}, {}};
    pick_until_done(run_state, record);
    return;
  }
  PickRecord unsettled;
  unsettled.outcome = PickOutcome::kUnsettled;
  unsettled.reason =
      heap.settled ? std::to_string(heap.escaped.size()) + " parts fell outside the bin" : heap.unsettled;
  unsettled.world_hash = record.drop_hash;
  record.picks.push_back(unsettled);
}

}  // namespace

TrialRecord run_trial(const Scenario& scenario, Seed seed, TrialContext& context, TrialPictures* pictures,
                      ReplayRecorder* replay) {
  const Stopwatch watch;
  TrialRecord record;
  record.scenario = scenario.name;
  record.scenario_hash = context.hash;
  record.seed = seed;
  try {
    run(scenario, seed, context, {pictures, replay}, record);
  } catch (const StorageError&) {
    throw;  // a full disk is not a property of the trial
  } catch (const std::exception& error) {
    record.failure = TrialFailure::kInternalError;
    record.error = error.what();
  }
  record.wall_total = watch.seconds();
  return record;
}

}  // namespace binpick

// Records with every field set, for the tests of this folder.
#pragma once

#include "evaluation/trial_record.hpp"

namespace binpick::examples {

inline MatchedEstimate matched(std::size_t estimate, std::size_t instance, bool right, double translation = 0.001) {
  MatchedEstimate match;
  match.estimate = estimate;
  match.instance = instance;
  match.score = 0.75;
  match.fit_rms = 1.0 / 3000;
  match.right = match.right_tight = right;
  match.right_2mm = false;
  match.error.mssd = 3 * translation;
  match.error.add_s = 0.5 * translation;
  match.error.translation = translation;
  match.error.rotation = 0.01;
  match.error.abs_xyz = translation * Eigen::Vector3d(0.6, 0, 0.8);
  match.error.abs_rpy = Eigen::Vector3d(0.001, 0.002, 0.003);
  return match;
}

/// A look that found `found` of `visible` parts, one estimate each, and how its pick ended.
inline PickRecord pick(PickOutcome outcome, std::size_t visible, std::size_t found) {
  PickRecord record;
  record.outcome = outcome;
  record.reason = outcome == PickOutcome::kSucceeded ? "" : "as the test says";
  for (std::size_t i = 0; i < found; ++i) record.check.estimates.push_back(matched(i, i, true));
  record.check.visible = visible;
  record.check.found = record.check.found_tight = found;
  record.check.counted = record.check.right = found;
  for (std::size_t i = 0; i < visible; ++i)
    record.seen.push_back({0, 0.1, 1 - 0.1 * static_cast<double>(i), 0.05 - 0.01 * static_cast<double>(i)});
  record.chosen = 0;
  record.rejections = {{"rim blocked", 3}, {"out of reach", 1}};
  record.sim_time = 9;
  record.motion_time = 8;
  if (outcome == PickOutcome::kSucceeded) record.place_error = 0.0123456789012345678;
  record.collisions = {{"lip on the bin", 2}};
  record.second_look = "no plan";
  record.look_time = 1.5;
  record.peak_force = 1e-300;
  record.frame_hash = 0xfedcba9876543210ull;
  record.estimates_hash = 1;
  record.world_hash = 2;
  record.wall = {0.02, 0.3, 0.1, 0.04, 0.46};
  record.plan_wall = 0.05;
  return record;
}

inline TrialRecord trial(std::uint64_t seed, std::vector<PickRecord> picks, int dropped = 10) {
  TrialRecord record;
  record.scenario = "bearing_bin";
  record.scenario_hash = "00000000000000aa";
  record.seed = Seed{seed};
  record.dropped = dropped;
  record.picks = std::move(picks);
  for (const PickRecord& p : record.picks) record.placed += p.outcome == PickOutcome::kSucceeded ? 1 : 0;
  record.settle_time = 1.5;
  record.worst_penetration = 0.0001;
  record.penetration_p99 = 0.0002;
  record.penetration_max = 0.0003;
  record.woken_energy = 1e-9;
  record.woken_motion = 0.0004;
  record.woken_share = 0.1;
  record.drop_hash = 3;
  record.wall_total = 12.5;
  return record;
}

/// Two piles of ten picks: all succeeded, all but one succeeded.
inline std::vector<TrialRecord> campaign() {
  std::vector<PickRecord> good(9, pick(PickOutcome::kSucceeded, 2, 2));
  good.push_back(pick(PickOutcome::kNoSeal, 2, 1));
  return {trial(5000, std::vector<PickRecord>(10, pick(PickOutcome::kSucceeded, 2, 2))), trial(5001, good)};
}

}  // namespace binpick::examples

// The fields of a record, listed once for writing, hashing and reading. Private to this folder. An archive is called as
// archive("key", value), archive.hash("key", value) and archive.list("key", items); the order here is the order of the
// line.
#pragma once

#include "evaluation/trial_record.hpp"

namespace binpick::record {

template <class Archive, class Estimate>
void estimate_fields(Archive& archive, Estimate& e) {
  archive("estimate", e.estimate);
  archive("instance", e.instance);
  archive("score", e.score);
  archive("fit_rms", e.fit_rms);
  archive("right", e.right);
  archive("right_tight", e.right_tight);
  archive("right_2mm", e.right_2mm);
  archive("ignored", e.ignored);
  archive("mssd", e.error.mssd);
  archive("add_s", e.error.add_s);
  archive("translation", e.error.translation);
  archive("rotation", e.error.rotation);
  archive("abs_xyz", e.error.abs_xyz);
  archive("abs_rpy", e.error.abs_rpy);
}

template <class Archive, class Pick>
void pick_fields(Archive& archive, Pick& pick) {
  archive("outcome", pick.outcome);
  archive("reason", pick.reason);
  archive("visible", pick.check.visible);
  archive("found", pick.check.found);
  archive("found_tight", pick.check.found_tight);
  archive("found_2mm", pick.check.found_2mm);
  archive("counted", pick.check.counted);
  archive("right", pick.check.right);
  archive.list("estimates", pick.check.estimates, [](auto& inner, auto& e) { estimate_fields(inner, e); });
  archive("chosen", pick.chosen);
  archive("lifted_body", pick.lifted_body);
  archive("rejections", pick.rejections);
  archive("sim_time", pick.sim_time);
  archive("motion_time", pick.motion_time);
  archive("place_error", pick.place_error);
  archive("place_rotation", pick.place_rotation);
  archive("swing", pick.swing);
  archive("peak_force", pick.peak_force);
  archive("hold_use", pick.hold_use);
  archive("contact_force", pick.contact_force);
  archive("contact_depth", pick.contact_depth);
  archive("contact", pick.contact);
  archive("collisions", pick.collisions);
  archive("collision_depth", pick.collision_depth);
  archive("second_look", pick.second_look);
  archive("look_time", pick.look_time);
  archive("neighbours_moved", pick.neighbours_moved);
  archive("neighbours_dragged", pick.neighbours_dragged);
  archive("parts_dropped_back", pick.parts_dropped_back);
  archive("parts_lost", pick.parts_lost);
  archive.hash("frame_hash", pick.frame_hash);
  archive.hash("estimates_hash", pick.estimates_hash);
  archive.hash("world_hash", pick.world_hash);
}

/// Everything that enters the hash.
template <class Archive, class Record>
void trial_fields(Archive& archive, Record& record) {
  archive("schema", record.schema);
  archive("scenario", record.scenario);
  archive("scenario_hash", record.scenario_hash);
  archive("seed", record.seed.key);
  archive("dropped", record.dropped);
  archive("placed", record.placed);
  archive("escaped", record.escaped);
  archive("settled", record.settled);
  archive("settle_time", record.settle_time);
  archive("worst_penetration", record.worst_penetration);
  archive("penetration_p99", record.penetration_p99);
  archive("penetration_max", record.penetration_max);
  archive("woken_energy", record.woken_energy);
  archive("woken_motion", record.woken_motion);
  archive("woken_share", record.woken_share);
  archive.if_any("calibration_translation", record.calibration_translation);
  archive.if_any("calibration_rotation", record.calibration_rotation);
  archive.hash("drop_hash", record.drop_hash);
  archive.if_any("failure", record.failure);
  archive("error", record.error);
  archive.list("picks", record.picks, [](auto& inner, auto& pick) { pick_fields(inner, pick); });
}

constexpr const char* kSumKey = ",\"sum\":\"";  // the last key of a line: of all bytes before it

/// Who ran it and how often: outside the hash. No key where there is nothing to say.
template <class Archive, class Record>
void run_fields(Archive& archive, Record& record) {
  archive.unless("build", record.build, std::string());
  archive.unless("attempts", record.attempts, 1);
  archive.unless("first_failure", record.first_failure, std::string());
}

/// What lay in the bin at each pick's look, as columns: outside the hash, since it follows from what is in it.
template <class Archive, class Record>
void seen_fields(Archive& archive, Record& record) {
  archive.list("seen", record.picks, [](auto& inner, auto& pick) {
    inner.column("part", pick.seen, &SeenInstance::part);
    inner.column("diameter", pick.seen, &SeenInstance::diameter);
    inner.column("visible", pick.seen, &SeenInstance::visible);
    inner.column("height", pick.seen, &SeenInstance::height);
  });
}

/// Wall times: outside the hash. The list is as long as `picks`.
template <class Archive, class Record>
void wall_fields(Archive& archive, Record& record) {
  archive("total", record.wall_total);
  archive.list("picks", record.picks, [](auto& inner, auto& pick) {
    inner("preprocess", pick.wall.preprocess);
    inner("voting", pick.wall.voting);
    inner("verification", pick.wall.verification);
    inner("icp", pick.wall.icp);
    inner("total", pick.wall.total);
    inner("plan", pick.plan_wall);
  });
}

}  // namespace binpick::record

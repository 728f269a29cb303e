// summary.json: the stable surface of ARCHITECTURE section 14. SI, but stage_ms in milliseconds.
#include <nlohmann/json.hpp>

#include "evaluation/rate_json.hpp"
#include "evaluation/summary.hpp"

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json stages_json(const std::map<std::string, StageSummary>& stages) {
  Json json = Json::object();
  for (const char* name : {"preprocess", "voting", "verification", "icp", "estimate_total", "plan"}) {
    const auto found = stages.find(name);
    if (found == stages.end()) continue;
    const StageSummary& s = found->second;
    json[name] = {{"median", 1e3 * s.median}, {"p95", 1e3 * s.p95}, {"mean", 1e3 * s.mean}};
  }
  return json;
}

/// Every outcome that exists, zeros included, so that a script need not ask whether a key is there.
Json outcomes_json(const std::map<std::string, std::size_t>& outcomes) {
  Json json = Json::object();
  for (PickOutcome outcome : all_pick_outcomes()) {
    const auto found = outcomes.find(to_string(outcome));
    json[to_string(outcome)] = found == outcomes.end() ? 0 : found->second;
  }
  return json;
}

}  // namespace

std::string summary_json(const CampaignSummary& s) {
  Json json;
  json["schema"] = kRecordSchema;
  json["scenario"] = s.scenario;
  json["trials"] = s.trials;
  json["cleared"] = {{"placed", s.cleared.hits},
                     {"dropped", s.cleared.total},
                     {"rate", s.cleared.rate},
                     {"interval", {s.cleared.interval.low, s.cleared.interval.high}}};
  json["picks"] = rate_json(s.picks, "attempted", "succeeded");
  json["recall"] = rate_json(s.recall, "visible", "found");
  json["precision"] = rate_json(s.precision, "counted", "right");
  json["recall_first_look"] = rate_json(s.recall_first_look, "visible", "found");
  json["recall_tight"] = rate_json(s.recall_tight, "visible", "found");
  json["recall_2mm"] = rate_json(s.recall_2mm, "visible", "found");
  json["translation_error_m"] = {
      {"median", s.translation_median}, {"p95", s.translation_p95}, {"mean_abs_xyz", vector_json(s.mean_abs_xyz)}};
  json["rotation_error_rad"] = {
      {"median", s.rotation_median}, {"p95", s.rotation_p95}, {"mean_abs_rpy", vector_json(s.mean_abs_rpy)}};
  json["errors_of"] = s.measured;
  json["stage_ms"] = stages_json(s.stages);
  json["heaps"] = {{"settled", s.heaps.settled},
                   {"moved_share", s.heaps.moved_share},
                   {"largest_motion_m", s.heaps.largest_motion},
                   {"penetration_p99_m", s.heaps.penetration_p99},
                   {"penetration_max_m", s.heaps.penetration_max}};
  json["collisions"] = {{"executed", s.collisions.executed},
                        {"collided", s.collisions.collided},
                        {"lips", s.collisions.lips},
                        {"depth_m", s.collisions.depth},
                        {"by_name", s.collisions.by_name}};
  json["cycle_s"] = {{"median", s.cycle_median}, {"motion_mean", s.motion_mean}};
  json["simulated_picks_per_hour"] = s.simulated_picks_per_hour;
  json["throughput_per_hour"] = s.throughput_per_hour;
  json["outcomes"] = outcomes_json(s.outcomes);
  json["outcome_seeds"] = Json::object();
  for (const auto& [outcome, seeds] : s.outcome_seeds) json["outcome_seeds"][outcome] = seeds;
  json["failed"] = s.failed;
  json["failure_seeds"] = Json::object();
  for (const auto& [failure, seeds] : s.failure_seeds) json["failure_seeds"][failure] = seeds;
  json["repeated_seeds"] = s.repeated_seeds;
  json["records_hash"] = s.records_hash;
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace binpick

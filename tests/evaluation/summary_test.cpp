// A campaign's figures from records that are known on paper.
#include "evaluation/summary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using examples::matched;
using examples::pick;
using examples::trial;
using nlohmann::json;

/// Three piles of 10: 19 of 30 placed in 23 attempts, one look at an empty bin.
std::vector<TrialRecord> three_piles() {
  std::vector<PickRecord> good(10, pick(PickOutcome::kSucceeded, 4, 4));
  good.push_back(pick(PickOutcome::kBinEmpty, 0, 0));
  std::vector<PickRecord> fair(9, pick(PickOutcome::kSucceeded, 5, 4));
  fair.push_back(pick(PickOutcome::kNoSeal, 5, 4));
  fair.push_back(pick(PickOutcome::kNoSeal, 5, 4));
  std::vector<PickRecord> bad = {pick(PickOutcome::kNoDetection, 3, 0), pick(PickOutcome::kSlipped, 3, 1)};
  bad[0].check.counted = 2;  // two wrong estimates
  bad[0].check.estimates = {matched(0, 0, false, 0.05), matched(1, 0, false, 0.05)};
  return {trial(7, good), trial(5, fair), trial(6, bad)};
}

TEST(Summary, CountsAreThoseOnPaper) {
  const CampaignSummary s = summarise(three_piles(), 3600);
  EXPECT_EQ(s.scenario, "bearing_bin");
  EXPECT_EQ(s.trials, 3u);
  EXPECT_EQ(s.cleared.hits, 19u);
  EXPECT_EQ(s.cleared.total, 30u);
  EXPECT_EQ(s.picks.hits, 19u);
  EXPECT_EQ(s.picks.total, 23u);  // the look at the empty bin is no attempt
  EXPECT_EQ(s.recall.hits, 10u * 4 + 11 * 4 + 1);
  EXPECT_EQ(s.recall.total, 10u * 4 + 11 * 5 + 6);
  EXPECT_EQ(s.precision.hits, 85u);
  EXPECT_EQ(s.precision.total, 87u);
  EXPECT_EQ(s.recall_first_look.hits, 4u + 4 + 0);
  EXPECT_EQ(s.recall_first_look.total, 4u + 5 + 3);
  EXPECT_EQ(s.recall_2mm.hits, 0u);
  EXPECT_EQ(s.outcomes.at("Succeeded"), 19u);
  EXPECT_EQ(s.outcomes.at("NoSeal"), 2u);
  EXPECT_EQ(s.outcome_seeds.at("NoSeal"), std::vector<std::uint64_t>{5});
  EXPECT_EQ(s.outcome_seeds.at("Slipped"), std::vector<std::uint64_t>{6});
  EXPECT_EQ(s.outcome_seeds.count("Succeeded"), 0u);
  EXPECT_EQ(s.throughput_per_hour, 23);
  EXPECT_NEAR(s.cleared.rate, 19.0 / 30, 1e-15);
  EXPECT_LT(s.cleared.interval.low, s.cleared.rate);
  EXPECT_GT(s.cleared.interval.high, s.cleared.rate);
}

TEST(Summary, AFailedTrialIsNoMeasurement) {
  std::vector<TrialRecord> records = three_piles();
  const CampaignSummary sound = summarise(records, 3600);
  TrialRecord crashed = trial(8, {});
  crashed.dropped = 10;
  crashed.failure = TrialFailure::kCrash;
  crashed.attempts = 2;
  TrialRecord broken = trial(9, {pick(PickOutcome::kInternalError, 2, 0)});  // as schema 4 told it at first
  broken.dropped = 10;
  records.push_back(crashed);
  records.push_back(broken);
  const CampaignSummary s = summarise(records, 3600);
  EXPECT_EQ(s.trials, 5u);
  EXPECT_EQ(s.failed, 2u);
  EXPECT_EQ(s.failure_seeds.at("Crash"), std::vector<std::uint64_t>{8});
  EXPECT_EQ(s.failure_seeds.at("InternalError"), std::vector<std::uint64_t>{9});
  EXPECT_EQ(s.repeated_seeds, std::vector<std::uint64_t>{8});
  EXPECT_EQ(s.cleared.total, sound.cleared.total);
  EXPECT_EQ(s.picks.total, sound.picks.total);
  EXPECT_EQ(s.recall.total, sound.recall.total);
  EXPECT_NE(s.records_hash, sound.records_hash);
}

TEST(Summary, ErrorsAreThoseOfRightEstimates) {
  PickRecord look = pick(PickOutcome::kSucceeded, 4, 0);
  look.check.estimates = {matched(0, 0, true, 0.001), matched(1, 1, true, 0.003), matched(2, 2, false, 0.5),
                          matched(3, 3, true, 0.7)};
  look.check.estimates[3].ignored = true;
  const std::vector<TrialRecord> records = {trial(1, {look})};
  const CampaignSummary s = summarise(records, 0);
  EXPECT_EQ(s.measured, 2u);
  EXPECT_NEAR(s.translation_median, 0.002, 1e-15);
  EXPECT_NEAR(s.translation_p95, 0.0029, 1e-15);
  EXPECT_LT((s.mean_abs_xyz - 0.002 * Eigen::Vector3d(0.6, 0, 0.8)).norm(), 1e-15);
  EXPECT_LT((s.mean_abs_rpy - Eigen::Vector3d(0.001, 0.002, 0.003)).norm(), 1e-15);
  EXPECT_EQ(s.throughput_per_hour, 0);
}

TEST(Summary, CycleIsThatOfSucceededPicks) {
  PickRecord quick = pick(PickOutcome::kSucceeded, 1, 1), slow = quick, failed = pick(PickOutcome::kNoSeal, 1, 1);
  quick.sim_time = 8;
  slow.sim_time = 10;
  slow.motion_time = 9;
  failed.sim_time = 1000;
  const std::vector<TrialRecord> records = {trial(1, {quick, slow, failed})};
  const CampaignSummary s = summarise(records, 0);
  EXPECT_EQ(s.cycle_median, 9);
  EXPECT_EQ(s.motion_mean, 8.5);
  EXPECT_EQ(s.simulated_picks_per_hour, 400);
}

TEST(Summary, CollisionsAreThoseOfPicksInWhichTheArmMoved) {
  PickRecord clean = pick(PickOutcome::kSucceeded, 1, 1), lip = clean, crash = clean, idle = clean;
  clean.collisions.clear();
  crash.collisions = {{"tool in the bin", 2}, {"link_4 in the tray", 1}, {"lip on the bin", 1}};
  crash.collision_depth = 0.003;
  idle.motion_time = 0;
  const std::vector<TrialRecord> records = {trial(1, {clean, lip}), trial(2, {crash, idle})};
  const CampaignSummary s = summarise(records, 0);
  EXPECT_EQ(s.collisions.executed, 3u);
  EXPECT_EQ(s.collisions.collided, 1u);
  EXPECT_EQ(s.collisions.lips, 2u);
  EXPECT_EQ(s.collisions.depth, 0.003);
  EXPECT_EQ(s.collisions.by_name.at("tool in the bin"), 2u);
  EXPECT_EQ(s.collisions.by_name.at("lip on the bin"), 3u);
}

TEST(Summary, StagesCountOnlyLooksThatReachedThem) {
  PickRecord seen = pick(PickOutcome::kSucceeded, 1, 1), blind = pick(PickOutcome::kUnsettled, 0, 0);
  blind.wall = {};
  blind.plan_wall = 0;
  const std::vector<TrialRecord> records = {trial(1, {seen}), trial(2, {blind})};
  const CampaignSummary s = summarise(records, 0);
  EXPECT_EQ(s.stages.at("voting").median, 0.3);
  EXPECT_EQ(s.stages.at("estimate_total").mean, 0.46);
  EXPECT_EQ(s.stages.at("plan").p95, 0.05);
}

TEST(Summary, OrderOfTheRecordsDoesNotMatter) {
  std::vector<TrialRecord> records = three_piles();
  const auto by_seed = [](const TrialRecord& a, const TrialRecord& b) { return a.seed.key < b.seed.key; };
  std::sort(records.begin(), records.end(), by_seed);
  const std::string before = summary_json(summarise(records, 100));
  int orders = 1;
  for (; std::next_permutation(records.begin(), records.end(), by_seed); ++orders) {
    EXPECT_EQ(summary_json(summarise(records, 100)), before);
  }
  EXPECT_EQ(orders, 6);
}

TEST(Summary, RecordsHashKnowsNoWallTime) {
  std::vector<TrialRecord> records = three_piles();
  const std::string before = summarise(records, 100).records_hash;
  records[1].wall_total = 1e6;
  records[0].picks[0].wall.icp = 3;
  EXPECT_EQ(summarise(records, 1).records_hash, before);
  records[1].placed -= 1;
  EXPECT_NE(summarise(records, 100).records_hash, before);
}

TEST(SummaryJson, HasTheKeysThatScriptsRelyOn) {
  const json s = json::parse(summary_json(summarise(three_piles(), 3600)));
  EXPECT_EQ(s["schema"], 4);
  EXPECT_EQ(s["trials"], 3);
  EXPECT_EQ(s["heaps"]["settled"], 3);
  EXPECT_EQ(s["heaps"]["largest_motion_m"], 0.0004);
  EXPECT_EQ(s["heaps"]["penetration_max_m"], 0.0003);
  EXPECT_EQ(s["cleared"]["placed"], 19);
  EXPECT_EQ(s["cleared"]["dropped"], 30);
  EXPECT_EQ(s["picks"]["attempted"], 23);
  EXPECT_EQ(s["picks"]["succeeded"], 19);
  EXPECT_EQ(s["recall"]["visible"], 101);
  EXPECT_EQ(s["recall"]["found"], 85);
  for (const char* rate : {"cleared", "picks", "recall", "precision", "recall_first_look"}) {
    EXPECT_TRUE(s[rate]["rate"].is_number()) << rate;
    ASSERT_EQ(s[rate]["interval"].size(), 2u) << rate;
    EXPECT_LE(s[rate]["interval"][0], s[rate]["rate"]) << rate;
    EXPECT_GE(s[rate]["interval"][1], s[rate]["rate"]) << rate;
  }
  for (const char* stage : {"preprocess", "voting", "verification", "icp", "estimate_total", "plan"}) {
    EXPECT_TRUE(s["stage_ms"][stage]["median"].is_number()) << stage;
    EXPECT_TRUE(s["stage_ms"][stage]["p95"].is_number()) << stage;
  }
  EXPECT_NEAR(s["stage_ms"]["voting"]["median"], 300, 1e-9);
  EXPECT_NEAR(s["translation_error_m"]["median"], 0.001, 1e-12);
  EXPECT_EQ(s["translation_error_m"]["mean_abs_xyz"].size(), 3u);
  EXPECT_NEAR(s["rotation_error_rad"]["p95"], 0.01, 1e-12);
  EXPECT_EQ(s["rotation_error_rad"]["mean_abs_rpy"].size(), 3u);
  EXPECT_EQ(s["cycle_s"]["median"], 9);
  EXPECT_EQ(s["simulated_picks_per_hour"], 400);
  EXPECT_EQ(s["throughput_per_hour"], 23);
  EXPECT_EQ(s["outcomes"]["Succeeded"], 19);
  EXPECT_EQ(s["outcomes"]["NoDetection"], 1);
  EXPECT_EQ(s["outcomes"]["PulledOff"], 0);
  EXPECT_EQ(s["records_hash"].get<std::string>().size(), 16u);
}

TEST(SummaryJson, NothingRecordedIsNullNotZero) {
  const json s = json::parse(summary_json(summarise({}, 0)));
  EXPECT_EQ(s["trials"], 0);
  EXPECT_TRUE(s["cleared"]["rate"].is_null());
  EXPECT_EQ(s["cleared"]["interval"], json::array({0.0, 1.0}));
  EXPECT_TRUE(s["translation_error_m"]["median"].is_null());
  EXPECT_TRUE(s["stage_ms"]["icp"]["median"].is_null());
}

}  // namespace
}  // namespace binpick

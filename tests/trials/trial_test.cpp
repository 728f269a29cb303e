// End to end: three scenes, a few seeds, at most three picks, with the oracle and with the real estimator.

#include "trials/trial.hpp"

#include <gtest/gtest.h>

#include <map>
#include <memory>

namespace binpick {
namespace {

struct Loaded {
  Scenario scenario;
  TrialContext context;
};

// Scenes are loaded once per process: a context remembers no trial, which AContextRemembersNothing holds it to.
Loaded& loaded(const std::string& name, const std::string& estimator) {
  static std::map<std::string, std::unique_ptr<Loaded>> cache;
  std::unique_ptr<Loaded>& entry = cache[name + estimator];
  if (!entry) {
    entry = std::make_unique<Loaded>();
    entry->scenario = read_scenario(std::string(BINPICK_SOURCE_DIR) + "/scenes/" + name + ".yaml");
    entry->scenario.trial.max_picks = 3;
    if (estimator == "oracle") {
      entry->scenario.estimator_type = "oracle";
      entry->scenario.estimator = nullptr;
    }
    entry->context = make_trial_context(entry->scenario);
  }
  return *entry;
}

int successes(const TrialRecord& record) {
  int count = 0;
  for (const PickRecord& pick : record.picks) count += pick.outcome == PickOutcome::kSucceeded ? 1 : 0;
  return count;
}

class SceneTest : public testing::TestWithParam<const char*> {};

TEST_P(SceneTest, TheOracleIsExactlyRight) {
  Loaded& scene = loaded(GetParam(), "oracle");
  int picked = 0, picks = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const TrialRecord record = run_trial(scene.scenario, Seed{seed}, scene.context);
    ASSERT_TRUE(record.error.empty()) << record.error << " seed " << seed;
    EXPECT_TRUE(record.settled) << "seed " << seed;
    for (const PickRecord& pick : record.picks) {
      EXPECT_EQ(pick.check.found, pick.check.visible) << "seed " << seed;
      EXPECT_EQ(pick.check.right, pick.check.counted) << "seed " << seed;
      for (const MatchedEstimate& match : pick.check.estimates) {
        EXPECT_LT(match.error.mssd, 1e-9) << "seed " << seed;
        EXPECT_LT(match.error.rotation, 1e-7) << "seed " << seed;
      }
    }
    picks += static_cast<int>(record.picks.size());
    picked += successes(record);
  }
  EXPECT_GE(picks, 4);
  EXPECT_GE(picked, 0.7 * picks);
}

TEST_P(SceneTest, TheRealEstimatorFindsAndPicks) {
  Loaded& scene = loaded(GetParam(), "real");
  std::size_t visible = 0, found = 0, counted = 0, right = 0;
  int picked = 0, picks = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {  // a pile can fail as a whole
    const TrialRecord record = run_trial(scene.scenario, Seed{seed}, scene.context);
    ASSERT_TRUE(record.error.empty()) << record.error << " seed " << seed;
    for (const PickRecord& pick : record.picks) {
      visible += pick.check.visible, found += pick.check.found;
      counted += pick.check.counted, right += pick.check.right;
    }
    picks += static_cast<int>(record.picks.size());
    picked += successes(record);
  }
  ASSERT_GE(visible, 20u);
  EXPECT_GE(double(found) / double(visible), 0.8) << found << " of " << visible;
  EXPECT_GE(double(right) / double(counted), 0.8) << right << " of " << counted;
  EXPECT_GE(picked, 0.6 * picks) << picked << " of " << picks;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneTest, testing::Values("bearing_bin", "bracket_bin", "tee_bin"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(Trial, SameSeedSameRecordInAnyContext) {
  Loaded& scene = loaded("bearing_bin", "real");
  const TrialRecord first = run_trial(scene.scenario, Seed{7}, scene.context);
  run_trial(scene.scenario, Seed{8}, scene.context);  // a context remembers no trial
  const TrialRecord again = run_trial(scene.scenario, Seed{7}, scene.context);
  EXPECT_EQ(record_hash(first), record_hash(again));
  TrialContext fresh = make_trial_context(scene.scenario);
  EXPECT_EQ(record_hash(first), record_hash(run_trial(scene.scenario, Seed{7}, fresh)));
  EXPECT_NE(record_hash(first), record_hash(run_trial(scene.scenario, Seed{9}, scene.context)));
}

TEST(Trial, ALargeStatedErrorLosesPicks) {
  Loaded& scene = loaded("bearing_bin", "oracle");
  Scenario blurred = scene.scenario;
  blurred.oracle.translation_error = 0.02;
  int exact = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    exact += successes(run_trial(scene.scenario, Seed{seed}, scene.context));
    wrong += successes(run_trial(blurred, Seed{seed}, scene.context));
  }
  EXPECT_LT(wrong, exact);
}

TEST(Trial, OnlyIfRightNeverMovesTheArmForAWrongEstimate) {
  Loaded& scene = loaded("bearing_bin", "oracle");
  Scenario careful = scene.scenario;
  careful.oracle.translation_error = 0.03;
  careful.trial.execute = "only_if_right";
  careful.second_look.when.clear();  // looking again moves the arm as well
  int held_back = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TrialRecord record = run_trial(careful, Seed{seed}, scene.context);
    for (const PickRecord& pick : record.picks) {
      if (!pick.chosen) continue;
      for (const MatchedEstimate& match : pick.check.estimates) {
        if (match.estimate != *pick.chosen || match.right) continue;
        ++held_back;
        EXPECT_EQ(pick.motion_time, 0) << "seed " << seed;
        EXPECT_EQ(pick.outcome, PickOutcome::kNoReachablePick) << "seed " << seed;
      }
    }
  }
  EXPECT_GE(held_back, 1);  // or nothing was tested
}

}  // namespace
}  // namespace binpick

#include "evaluation/error_budget.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.hpp"

namespace binpick {
namespace {

/// `cleared[k]` of ten parts of pile k, in ten picks.
BudgetRun run_of(const std::string& name, const std::vector<int>& cleared, double error = 0) {
  BudgetRun run{name, error, {}};
  for (std::size_t k = 0; k < cleared.size(); ++k)
    run.records.piles.push_back({5000 + k, {double(cleared[k]), 10}, {double(cleared[k]), 10}});
  return run;
}

TEST(ErrorBudget, AStageCostsWhatItsOracleGains) {
  const std::vector<int> base = {8, 9, 8, 7, 9, 8, 8, 9, 7, 8, 9, 8, 8, 7, 9, 8, 8, 9, 8, 8};
  std::vector<int> better(base), one(base);
  for (int& n : better) n = 10;
  one[3] = 8;  // one part more in one pile of twenty: luck
  const auto rows = budget_rows(
      std::vector<BudgetRun>{run_of("as it is", base), run_of("pose", better), run_of("seal", one)}, Seed{1});
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].cleared.hits, 163u);
  EXPECT_NEAR(rows[1].cleared_gain.value, 37.0 / 200, 1e-12);
  EXPECT_LT(rows[1].cleared_gain.interval.low, 37.0 / 200);
  EXPECT_GT(rows[1].cleared_gain.interval.low, 0.1);
  EXPECT_GT(rows[1].cleared_gain.interval.high, 37.0 / 200);
  EXPECT_LT(rows[1].cleared_gain.p, 0.001);
  EXPECT_NEAR(rows[2].cleared_gain.value, 1.0 / 200, 1e-12);
  EXPECT_LT(rows[2].cleared_gain.interval.low, 0);
  EXPECT_GT(rows[2].cleared_gain.p, 0.4);
}

TEST(ErrorBudget, OnlyCommonSeedsArePaired) {
  BudgetRun oracle = run_of("pose", {10, 10, 10});
  oracle.records.piles[0].seed = 9;  // not in the base
  const auto rows = budget_rows(std::vector<BudgetRun>{run_of("as it is", {0, 5, 5}), oracle}, Seed{1});
  EXPECT_NEAR(rows[1].cleared_gain.value, 0.5, 1e-12);
  for (SweepPile& pile : oracle.records.piles) pile.seed += 100000;
  EXPECT_THROW(budget_rows(std::vector<BudgetRun>{run_of("as it is", {0, 5, 5}), oracle}, Seed{1}), SpecError);
}

TEST(ErrorBudget, TheBearableErrorIsReadOffBetweenThePoints) {
  const std::vector<int> all(10, 10), nine(10, 9);
  auto rows = budget_rows(
      std::vector<BudgetRun>{run_of("none", all), run_of("1 mm", all, 0.001), run_of("2 mm", nine, 0.002)}, Seed{1});
  ASSERT_TRUE(bearable_error(rows));
  EXPECT_NEAR(*bearable_error(rows), 0.0015, 1e-12);  // 100 % at 1 mm, 90 % at 2 mm: 95 % half way
  rows.pop_back();
  EXPECT_FALSE(bearable_error(rows)) << "nothing was lost";
}

TEST(ErrorBudget, TablesSayTheSame) {
  ErrorBudget budget;
  budget.scene = "a|b";
  budget.first_seed = 5000;
  budget.end_seed = 5002;
  budget.absent = {"calibration"};
  budget.stages = budget_rows(std::vector<BudgetRun>{run_of("as it is", {8, 8}), run_of("pose", {10, 10})}, Seed{1});
  EXPECT_THAT(budget_text(budget), testing::HasSubstr("+20.0"));
  EXPECT_THAT(budget_text(budget), testing::HasSubstr("calibration: perfect in this scene already"));
  EXPECT_THAT(budget_markdown(budget), testing::HasSubstr("a\\|b"));
  EXPECT_THAT(budget_csv(budget), testing::HasSubstr("stages,\"pose\",0.0,2,20,20,1.0,"));
  const auto parsed = nlohmann::json::parse(budget_json(budget));
  EXPECT_EQ(parsed.at("schema"), 1);
  EXPECT_NEAR(parsed.at("stages")[1].at("cleared_gain").at("value").get<double>(), 0.2, 1e-12);
  EXPECT_TRUE(parsed.at("bearable_translation").is_null());
}

}  // namespace
}  // namespace binpick

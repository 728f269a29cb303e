// Sweeps: figures, comparisons and verdicts on made-up records whose answer is known.

#include "evaluation/sweep_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "tests/core/temp_folder.hpp"
#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kNoResamples = 2;  // where no interval is looked at

/// Two factors of these sizes, every combination, seeds 100 ..
SweepPlan plan_of(std::size_t rows, std::size_t columns, std::size_t seeds) {
  SweepPlan plan;
  plan.name = "made up";
  plan.base = "scene.yaml";
  plan.first_seed = 100;
  plan.end_seed = 100 + seeds;
  plan.factors = {{"height", {"cell.height"}, {}, false}, {"cup", {"cell.cup"}, {}, false}};
  for (std::size_t r = 0; r < rows; ++r) plan.factors[0].levels.push_back("h" + std::to_string(r));
  for (std::size_t c = 0; c < columns; ++c) plan.factors[1].levels.push_back("c" + std::to_string(c));
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const std::vector<std::string> values = {plan.factors[0].levels[r], plan.factors[1].levels[c]};
      plan.cells.push_back({"cells/" + values[0] + "-" + values[1], {r, c}, values});
    }
  return plan;
}

/// Every seed of the plan: `cleared` of ten parts in as many picks as it took.
SweepRecords records_of(const SweepPlan& plan, double cleared, double picks = 10) {
  SweepRecords records;
  for (std::uint64_t seed = plan.first_seed; seed < plan.end_seed; ++seed)
    records.piles.push_back({seed, {cleared, 10}, {cleared, picks}});
  records.summary.trials = records.piles.size();
  records.summary.cleared = {
      static_cast<std::size_t>(cleared) * records.piles.size(), 10 * records.piles.size(), cleared / 10, {0, 1}};
  return records;
}

TEST(SweepFigures, BestCellAndWhatCannotBeToldFromIt) {
  const SweepPlan plan = plan_of(2, 2, 16);
  const std::vector<SweepRecords> records = {records_of(plan, 8), records_of(plan, 10), records_of(plan, 10),
                                             records_of(plan, 5)};
  const SweepResult result = sweep_result(plan, records);
  EXPECT_EQ(result.best, 1u);
  EXPECT_THAT(not_worse(result), ElementsAre(1, 2));
  // All 16 piles lost: one of 2^16 sign patterns is as bad. Two such tests among 4 x 3 that might have been made.
  const double p = std::pow(0.5, 16);
  EXPECT_DOUBLE_EQ(result.cells[3].difference->p, p);
  EXPECT_DOUBLE_EQ(result.cells[3].difference->p_holm, 12 * p);
  EXPECT_DOUBLE_EQ(result.cells[0].difference->p_holm, 12 * p);
  EXPECT_TRUE(result.cells[0].difference->worse);
  EXPECT_NEAR(result.cells[0].difference->value, -0.2, 1e-12);
  EXPECT_NEAR(result.cells[0].difference->interval.low, -0.2, 1e-12);  // every pile says the same
  EXPECT_NEAR(result.cells[0].difference->interval.high, -0.2, 1e-12);
  EXPECT_DOUBLE_EQ(result.cells[2].difference->p, 1);
  EXPECT_FALSE(result.cells[1].difference.has_value());
  EXPECT_THAT(sweep_text(result), HasSubstr("Best cell: h0, c1 with 100.0 %"));
  EXPECT_THAT(sweep_text(result), HasSubstr("1 cannot be told from it and 2 are worse"));
}

TEST(SweepFigures, LevelsPoolTheirCellsAndMapsShowThePairs) {
  const SweepPlan plan = plan_of(2, 3, 16);
  std::vector<SweepRecords> records;
  for (const double cleared : {10, 9, 8, 7, 6, 5}) records.push_back(records_of(plan, cleared));
  const SweepResult result = sweep_result(plan, records);
  ASSERT_EQ(result.factors.size(), 2u);
  EXPECT_EQ(result.factors[0].best, 0u);
  EXPECT_NEAR(result.factors[0].levels[0].cleared.rate, 0.9, 1e-12);
  EXPECT_EQ(result.factors[0].levels[0].cleared.total, 480u);
  EXPECT_NEAR(result.factors[0].levels[1].difference->value, -0.3, 1e-12);
  EXPECT_NEAR(result.factors[1].levels[2].difference->value, -0.2, 1e-12);
  // 2 x 1 and 3 x 2 comparisons of levels make the family.
  EXPECT_DOUBLE_EQ(result.factors[1].levels[2].difference->p_holm, 8 * std::pow(0.5, 16));
  ASSERT_EQ(result.heat_maps.size(), 1u);
  EXPECT_THAT(result.heat_maps[0].share[1], ElementsAre(0.7, 0.6, 0.5));
  EXPECT_EQ(result.heat_maps[0].trials[0][0], 16u);
}

TEST(SweepFigures, OfThreeFactorsTheMapsComeByLevelOfTheThirdToo) {
  SweepPlan plan = plan_of(2, 2, 4);
  plan.factors.push_back({"sensor", {"sensor.preset"}, {"s0", "s1", "s2"}, false});
  const std::vector<SweepCellPlan> pairs = std::exchange(plan.cells, {});
  std::vector<SweepRecords> records;
  for (std::size_t s = 0; s < 3; ++s)
    for (SweepCellPlan cell : pairs) {
      cell.folder += "-s" + std::to_string(s);
      cell.levels.push_back(s);
      cell.values.push_back("s" + std::to_string(s));
      plan.cells.push_back(cell);
      records.push_back(records_of(plan, s == 2 && cell.levels[0] == 1 ? 4 : 10));
    }
  const SweepResult result = sweep_result(plan, records, kNoResamples);
  ASSERT_EQ(result.heat_maps.size(), 3u + 3 + 2 + 2);
  EXPECT_FALSE(result.heat_maps[0].given);
  EXPECT_NEAR(result.heat_maps[0].share[1][0], 0.8, 1e-12);
  EXPECT_EQ(result.heat_maps[3].given, std::make_pair(std::size_t{2}, std::size_t{2}));
  EXPECT_NEAR(result.heat_maps[3].share[1][0], 0.4, 1e-12);
}

// Whoever picks the best of nine equal cells picks a lucky one: at 5 % the others must not be called worse more often.
TEST(SweepFigures, EqualCellsAreSeldomCalledWorse) {
  SweepPlan plan = plan_of(3, 3, 12);
  std::size_t alarms = 0;
  constexpr std::size_t kSweeps = 200;
  for (std::size_t k = 0; k < kSweeps; ++k) {
    std::vector<SweepRecords> records;
    for (std::size_t c = 0; c < plan.cells.size(); ++c) {
      records.push_back(records_of(plan, 0));
      Rng rng = Seed{k}.child("cell", c).rng();
      for (SweepPile& pile : records.back().piles)
        for (int part = 0; part < 10; ++part) pile.cleared.hits += rng.uniform() < 0.85 ? 1 : 0;
    }
    alarms += not_worse(sweep_result(plan, records, kNoResamples)).size() < plan.cells.size() ? 1 : 0;
  }
  EXPECT_GT(binomial_at_least(alarms, kSweeps, plan.alpha), 1e-3) << alarms;
}

TEST(SweepFigures, OnlyCommonSeedsAreComparedAndFailedTrialsAreNoPiles) {
  const SweepPlan plan = plan_of(1, 2, 4);
  TrialRecord good = examples::trial(100, {examples::pick(PickOutcome::kSucceeded, 4, 3)}, 1);
  TrialRecord crashed = examples::trial(101, {}, 1);
  crashed.failure = TrialFailure::kCrash;
  TrialRecord third = examples::trial(102, {examples::pick(PickOutcome::kNoSeal, 4, 3)}, 1);
  const std::vector<SweepRecords> records = {sweep_records(std::vector{good, crashed, third}),
                                             sweep_records(std::vector{third})};
  ASSERT_EQ(records[0].piles.size(), 2u);
  EXPECT_EQ(records[0].summary.failed, 1u);
  const SweepResult result = sweep_result(plan, records);
  EXPECT_EQ(result.cells[1].missing, 3u);
  EXPECT_EQ(result.best, 0u);
  EXPECT_EQ(result.cells[1].difference->seeds, 1u);
  EXPECT_EQ(result.cells[1].difference->value, 0);  // on the seed that both have; not 0 % against 50 %
  EXPECT_THAT(sweep_text(result), HasSubstr("1 trials failed to run"));
}

TEST(SweepFigures, NothingRunYetIsSaidAndHasNoFigures) {
  const SweepPlan plan = plan_of(2, 2, 3);
  const SweepResult result = sweep_result(plan, std::vector<SweepRecords>(4));
  EXPECT_FALSE(result.best);
  EXPECT_THAT(sweep_text(result), HasSubstr("Nothing has been run yet"));
  EXPECT_THAT(sweep_text(result), HasSubstr("12 trials have no record yet"));
  EXPECT_THAT(sweep_json(result), HasSubstr("\"best\": null"));
}

TEST(SweepFigures, ThePlanReadsBackFromItsFile) {
  SweepPlan plan = plan_of(2, 3, 5);
  plan.design = "latin_hypercube";
  plan.objective = "picks";
  plan.factors[0].range = true;
  plan.name = "a \"quoted\" name";
  const std::string text = sweep_json(sweep_result(plan, std::vector<SweepRecords>(6)));
  const TempFolder folder;
  folder.put("sweep.json", text);
  const SweepPlan again = read_sweep_plan(folder.at("."));
  EXPECT_EQ(sweep_json(sweep_result(again, std::vector<SweepRecords>(6))), text);
  EXPECT_TRUE(again.factors[0].range);
  const auto error = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    folder.put("sweep.json", changed);
    try {
      read_sweep_plan(folder.at("."));
    } catch (const SpecError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error("\"schema\": 1", "\"schema\": 9"), HasSubstr("sweep.json: schema: 9 is not 1"));
  EXPECT_THAT(error("cells/h0-c0", "../../etc"), HasSubstr("is not in cells/"));
  EXPECT_THAT(error("\"alpha\"", "\"alfa\""), HasSubstr("alpha: is missing"));
  EXPECT_THAT(error("{", "["), HasSubstr("is not JSON"));
  EXPECT_THAT(error("\"levels\": [\n    0,", "\"levels\": [\n    7,"), HasSubstr("does not fit the factors"));
}

TEST(SweepFigures, ThePageShowsMapsAndLeadsToCellsAndNoNameIsMarkup) {
  SweepPlan plan = plan_of(1, 2, 4);
  const std::string attack = "\"><script>alert('x')</script><img src=x onerror=alert(1)>&";
  plan.name = plan.factors[0].name = attack;
  plan.cells[0].values[0] = attack;
  plan.cells[1].folder = "javascript:alert(1)/..";
  const SweepResult result = sweep_result(plan, std::vector<SweepRecords>(2, records_of(plan, 9)), kNoResamples);
  const std::string page = html_sweep(result, {{attack, "no real PNG"}});
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("<img src=x"), std::string::npos);
  EXPECT_THAT(page, HasSubstr("<img src=\"data:image/png;base64,bm8gcmVhbCBQTkc=\""));
  EXPECT_THAT(page, HasSubstr("Best cell: "));
  EXPECT_THAT(page, HasSubstr("href=\"cells/h0-c0/report.html\""));
  EXPECT_EQ(page.find("href=\"javascript"), std::string::npos);
}

TEST(SweepFigures, TablesForMachinesHoldOneRowEach) {
  SweepPlan plan = plan_of(1, 2, 3);
  plan.factors[1].levels[1] = plan.cells[1].values[1] = "a, \"b\"";
  plan.factors[0].levels[0] = "=1+1";
  const SweepResult result = sweep_result(plan, std::vector{records_of(plan, 10), records_of(plan, 5)});
  const std::string cells = sweep_cells_csv(result), factors = sweep_factors_csv(result);
  EXPECT_EQ(std::count(cells.begin(), cells.end(), '\n'), 3);
  EXPECT_EQ(std::count(factors.begin(), factors.end(), '\n'), 4);
  EXPECT_THAT(cells, HasSubstr("h0,\"a, \"\"b\"\"\",3,0,0,15,30,0.5"));
  EXPECT_THAT(factors, HasSubstr("height,'=1+1,2,45,60,0.75"));
  EXPECT_THAT(sweep_markdown(result), HasSubstr("| h0 | c0 |"));
}

}  // namespace
}  // namespace binpick

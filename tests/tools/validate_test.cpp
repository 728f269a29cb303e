// `binpick validate`: the verdicts themselves, the statistics behind the quick form's tolerances, and the quick form.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/file_io.hpp"
#include "sim/noise/correlated_field.hpp"
#include "tests/tools/run_program.hpp"
#include "tools/validate/verdict.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;
using Rule = Verdict::Rule;

Verdict verdict(double value, double tolerance, Rule rule) {
  return {"V-X1", "something", value, 2.0, tolerance, "m", rule};
}

TEST(Verdict, RulesAndTheirTolerance) {
  EXPECT_TRUE(verdict(2.1, 0.11, Rule::kWithin).pass());
  EXPECT_FALSE(verdict(2.2, 0.11, Rule::kWithin).pass());
  EXPECT_FALSE(verdict(1.8, 0.11, Rule::kWithin).pass());
  EXPECT_TRUE(verdict(2.001, 0, Rule::kAbove).pass());
  EXPECT_FALSE(verdict(1.95, 0, Rule::kAbove).pass());
  EXPECT_TRUE(verdict(1.95, 0.1, Rule::kAbove).pass());
  EXPECT_TRUE(verdict(1.999, 0, Rule::kBelow).pass());
  EXPECT_FALSE(verdict(2.05, 0, Rule::kBelow).pass());
  EXPECT_TRUE(verdict(2.05, 0.1, Rule::kBelow).pass());
}

TEST(Verdict, WhatIsNotANumberNeverPassesAndIsNullInJson) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Verdict> verdicts;
  for (const Rule rule : {Rule::kWithin, Rule::kAbove, Rule::kBelow}) verdicts.push_back(verdict(nan, 10, rule));
  for (const Verdict& v : verdicts) EXPECT_FALSE(v.pass());
  EXPECT_FALSE(all_pass(verdicts));
  EXPECT_TRUE(nlohmann::json::parse(json_of(verdicts))[0]["value"].is_null());
}

TEST(Verdict, TheTableIsForPeopleAndTheJsonInMetres) {
  const std::vector<Verdict> verdicts = {verdict(1.5, 0.01, Rule::kWithin)};
  EXPECT_THAT(table_of(verdicts), HasSubstr("1500 mm"));
  EXPECT_THAT(table_of(verdicts), HasSubstr("FAIL"));
  EXPECT_THAT(table_of(verdicts), HasSubstr("0 of 1 pass"));
  const auto row = nlohmann::json::parse(json_of(verdicts))[0];
  EXPECT_EQ(row["id"], "V-X1");
  EXPECT_EQ(row["value"], 1.5);
  EXPECT_EQ(row["expected"], 2.0);
  EXPECT_EQ(row["tolerance"], 0.01);
  EXPECT_EQ(row["unit"], "m");
  EXPECT_EQ(row["pass"], false);
}

TEST(Sampling, TheFullFormIsNotWidened) {
  EXPECT_EQ(widened(0.05, 0.01, 0.01), 0.05);
  EXPECT_EQ(widened(0.05, 0.008, 0.01), 0.05);
  EXPECT_DOUBLE_EQ(widened(0.05, 0.02, 0.01), 0.08);
  EXPECT_DOUBLE_EQ(rms_standard_error(10000, 0, 1), 1 / std::sqrt(20000.0));  // white: 1 / sqrt(2 n)
}

// The spread of the RMS over many independent fields is what the formula says, for white and for correlated noise.
TEST(Sampling, TheRmsOfCorrelatedNoiseSpreadsAsStated) {
  constexpr int kSide = 64, kFields = 600;
  for (const double length : {0.0, 1.0, 2.5}) {
    double sum = 0, squares = 0;
    for (std::uint64_t k = 0; k < kFields; ++k) {
      const Seed seed = Seed{31}.child("field", k);
      double field = 0;
      for (const float g : correlated_field(kSide, kSide, {length, 0}, seed.rng(), seed.child("other").rng()))
        field += g * g / (kSide * kSide);
      sum += std::sqrt(field) / kFields;
      squares += field / kFields;
    }
    const double spread = std::sqrt(squares - sum * sum);
    const double stated = rms_standard_error(kSide * kSide, length, 1);
    // A spread over n fields is known to 1 / sqrt(2 n) = 3 %; the stated one leaves out the field's border (a few %).
    EXPECT_NEAR(spread, stated, 0.12 * stated) << "length " << length;
  }
}

TEST(ValidateSensors, TheQuickFormPassesEveryCheck) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program("validate sensors --quick --json " + folder.path("v.json"));
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  EXPECT_TRUE(run.err.empty()) << run.err;
  const auto rows = nlohmann::json::parse(read_file(folder.path("v.json")));
  std::set<std::string> ids;
  for (const auto& row : rows) {
    ids.insert(row.at("id").get<std::string>());
    EXPECT_TRUE(row.at("pass").get<bool>()) << row;
    for (const char* key : {"value", "expected", "tolerance"}) EXPECT_TRUE(row.at(key).is_number()) << key;
    EXPECT_THAT(run.out, HasSubstr(row.at("what").get<std::string>()));
  }
  EXPECT_THAT(ids, testing::ElementsAre("V-A1", "V-A2", "V-A3", "V-A4", "V-A5", "V-A6", "V-A7", "V-A8"));
}

TEST(Verdict, AnIntervalIsShownWithItsDraws) {
  Verdict drawn = verdict(1.5, 0.01, Rule::kWithin);
  drawn.samples = 7, drawn.low = 1.4, drawn.high = 1.6;
  EXPECT_THAT(table_of({drawn}), HasSubstr("1400..1600 (7)"));
  const auto row = nlohmann::json::parse(json_of({drawn}))[0];
  EXPECT_EQ(row["samples"], 7);
  EXPECT_EQ(row["low"], 1.4);
  EXPECT_EQ(row["high"], 1.6);
  EXPECT_FALSE(nlohmann::json::parse(json_of({verdict(1.5, 0.01, Rule::kWithin)}))[0].contains("samples"));
}

TEST(ValidateSuction, TheQuickFormPassesEveryCheck) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program("validate suction --quick --seeds 100:104 --json " + folder.path("v.json"));
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  std::set<std::string> ids;
  for (const auto& row : nlohmann::json::parse(read_file(folder.path("v.json")))) {
    ids.insert(row.at("id").get<std::string>());
    EXPECT_TRUE(row.at("pass").get<bool>()) << row;
    if (!row.contains("samples")) continue;
    EXPECT_GE(row.at("samples").get<int>(), 4) << row;
    EXPECT_LE(row.at("low").get<double>(), row.at("value").get<double>()) << row;
    EXPECT_GE(row.at("high").get<double>(), row.at("value").get<double>()) << row;
  }
  EXPECT_THAT(ids, testing::ElementsAre("V-B1", "V-B2", "V-B3", "V-B4", "V-B5"));
}

TEST(ValidateSensors, ThreadsDoNotChangeAnyValue) {
  const TemporaryFolder folder;
  const std::string one = "validate sensors --quick --seeds 7:9 --threads ";
  run_program(one + "1 --json " + folder.path("1.json"));
  run_program(one + "3 --json " + folder.path("3.json"));
  EXPECT_EQ(read_file(folder.path("1.json")), read_file(folder.path("3.json")));
  EXPECT_GT(nlohmann::json::parse(read_file(folder.path("1.json"))).size(), 30u);
}

}  // namespace
}  // namespace binpick

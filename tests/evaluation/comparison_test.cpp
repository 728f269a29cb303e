// Two versions compared: bits first, the stage that differs, pairing, findings, and what is written for CI.
#include "evaluation/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/yaml.hpp"
#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using examples::pick;
using examples::trial;
using testing::HasSubstr;

constexpr PickOutcome kOk = PickOutcome::kSucceeded, kFail = PickOutcome::kNoSeal;

// A pile of ten attempts, the first `failed` of which fail; hashes tell where it departs.
TrialRecord pile(std::uint64_t seed, int failed) {
  std::vector<PickRecord> picks;
  for (int i = 0; i < 10; ++i) picks.push_back(pick(i < failed ? kFail : kOk, 6, 6));
  TrialRecord record = trial(seed, picks, 10 - failed);
  return record;
}

PileSet set_of(const std::string& name, const std::vector<TrialRecord>& records) { return pile_set(name, records); }

std::vector<TrialRecord> piles(std::size_t count, const std::function<int(std::size_t)>& failed) {
  std::vector<TrialRecord> records;
  for (std::size_t i = 0; i < count; ++i) records.push_back(pile(i, failed(i)));
  return records;
}

const MetricComparison& metric(const Comparison& comparison, const std::string& name) {
  for (const MetricComparison& m : comparison.metrics)
    if (m.name == name) return m;
  throw std::runtime_error(name);
}

TEST(StageBits, NamesTheFirstStageThatDiffers) {
  const TrialRecord record = pile(7, 2);
  const PileFigures base = figures_of(record);
  EXPECT_FALSE(first_difference(base, base));
  const auto stage_after = [&](const std::function<void(TrialRecord&)>& change) {
    TrialRecord changed = record;
    change(changed);
    const std::optional<BitDifference> found = first_difference(base, figures_of(changed));
    return found ? describe(*found) : "none";
  };
  EXPECT_EQ(stage_after([](TrialRecord& r) { r.drop_hash = 9, r.picks[3].frame_hash = 9; }), "heap");
  EXPECT_EQ(stage_after([](TrialRecord& r) { r.picks[3].frame_hash = 9, r.picks[4].frame_hash = 9; }), "turn 3: frame");
  EXPECT_EQ(stage_after([](TrialRecord& r) { r.picks[3].estimates_hash = 9, r.picks[3].world_hash = 9; }),
            "turn 3: estimates");
  EXPECT_EQ(stage_after([](TrialRecord& r) { r.picks[0].world_hash = 9; }), "turn 0: pick");
  EXPECT_EQ(stage_after([](TrialRecord& r) { r.picks.pop_back(); }), "turn 8: pick");
  EXPECT_EQ(stage_after([](TrialRecord& r) { r.picks[5].check.estimates[0].error.mssd *= 2; }),
            "figures of the record");
  // What was asked for and how long it took are no result.
  EXPECT_EQ(stage_after([](TrialRecord& r) { r.scenario_hash = "1234567890abcdef", r.wall_total = 99; }), "none");
}

// A record of another schema has other contents always: stages and figures decide.
TEST(StageBits, AnotherSchemaIsNoDifference) {
  const PileFigures base = figures_of(pile(7, 2));
  PileFigures fresh = base;
  fresh.content_hash = 5;
  EXPECT_TRUE(first_difference(base, fresh));
  EXPECT_FALSE(first_difference(base, fresh, false));
  fresh.translations[3] += 1e-6;
  EXPECT_EQ(describe(first_difference(base, fresh, false).value()), "figures of the record");
}

TEST(Compare, EqualBitsNeedNoTest) {
  const std::vector<TrialRecord> records = piles(60, [](std::size_t i) { return i % 3 == 0 ? 1 : 0; });
  const Comparison same = compare(set_of("a", records), set_of("b", records), {});
  EXPECT_EQ(same.verdict, Verdict::kNoBitChanged);
  EXPECT_EQ(exit_code(same), 0);
  EXPECT_THAT(sentence(same), HasSubstr("No bit changed in 60 seeds: pass"));
  // Of sixty none: (1 - p)^60 = 2.5 %.
  EXPECT_NEAR(same.changed_share.high, 1 - std::pow(0.025, 1.0 / 60), 1e-12);
  for (const MetricComparison& m : same.metrics) EXPECT_EQ(m.loss, 0) << m.name;
}

// 95 -> 85 %: in thirty of sixty piles one pick more fails, in none one less.
TEST(Compare, FindsARealLoss) {
  const auto before = piles(60, [](std::size_t i) { return i % 2; });
  const auto after = piles(60, [](std::size_t i) { return i % 2 + (i % 4 < 2 ? 2 : 0); });
  std::vector<TrialRecord> changed = after;
  for (TrialRecord& record : changed) record.picks[0].estimates_hash = 77;
  const Comparison found = compare(set_of("a", before), set_of("run/b", changed), {});
  const MetricComparison& picks = metric(found, "picks");
  EXPECT_DOUBLE_EQ(picks.base, 0.95);
  EXPECT_DOUBLE_EQ(picks.fresh, 0.85);
  EXPECT_EQ(picks.worse_piles, 30u);
  EXPECT_EQ(picks.better_piles, 0u);
  EXPECT_LE(picks.interval.low, picks.loss);
  EXPECT_GE(picks.interval.high, picks.loss);
  // Thirty losses of one size: 2^-30 at least; the drawn test cannot see below 1 / 400001.
  EXPECT_NEAR(picks.p, 1.0 / 400001, 1e-12);
  EXPECT_EQ(picks.finding, Finding::kWorse);
  EXPECT_EQ(metric(found, "recall").finding,
            Finding::kUnclear);  // no pile differs, but sixty piles are few for 2 points
  EXPECT_EQ(exit_code(found), 1);
  EXPECT_THAT(sentence(found), HasSubstr("picks succeeded 95.0 % -> 85.0 %"));
  ASSERT_EQ(found.flips.size(), 15u);  // those that were clean before: 15 lost the first pick
  EXPECT_EQ(found.flips[0].what, "first pick Succeeded -> NoSeal");
  EXPECT_EQ(found.flips[0].stage, "turn 0: estimates");
  EXPECT_EQ(replay_command(found, 4), "binpick trial run/b/scenario.yaml --seed 4 --out replay/seed-4");
  EXPECT_EQ(metric(found, "first_pick").worse_piles, 15u);
  EXPECT_DOUBLE_EQ(metric(found, "first_pick").p, std::ldexp(1.0, -15));
  // The other way round nothing is worse.
  const Comparison better = compare(set_of("b", changed), set_of("a", before), {});
  EXPECT_NE(better.verdict, Verdict::kWorse);
  EXPECT_EQ(metric(better, "picks").finding, Finding::kHolds);
}

TEST(Compare, HoldsWhereTheIntervalEndsBelowTheMargin) {
  // One pick more in 20 of 400 piles, one less in 20 others: loss 0, +- well below 5 points.
  const auto before = piles(400, [](std::size_t i) { return i % 20 == 0 ? 1 : 0; });
  const auto after = piles(400, [](std::size_t i) { return i % 20 == 1 ? 1 : 0; });
  const Comparison held = compare(set_of("a", before), set_of("b", after), {});
  EXPECT_EQ(metric(held, "picks").finding, Finding::kHolds);
  EXPECT_EQ(held.verdict, Verdict::kHolds) << comparison_text(held);
  EXPECT_EQ(exit_code(held), 0);
  const Comparison few = compare(set_of("a", piles(12, [](std::size_t i) { return i % 2; })),
                                 set_of("b", piles(12, [](std::size_t i) { return (i + 1) % 2; })), {});
  EXPECT_EQ(few.verdict, Verdict::kInconclusive);
  EXPECT_EQ(exit_code(few), 3);
}

// A loss that is proven, but smaller than its margin, is no regression.
TEST(Compare, ASmallLossIsWithinTheMargin) {
  const auto before = piles(400, [](std::size_t) { return 0; });
  const auto after = piles(400, [](std::size_t i) { return i % 10 == 0 ? 1 : 0; });
  const MetricComparison picks = metric(compare(set_of("a", before), set_of("b", after), {}), "picks");
  EXPECT_LT(picks.p_holm, 1e-3);
  EXPECT_NEAR(picks.loss, 0.01, 1e-12);
  EXPECT_EQ(picks.finding, Finding::kHolds);
}

TEST(Compare, AMissedPartIsAnErrorWithoutBound) {
  std::vector<TrialRecord> before = piles(40, [](std::size_t) { return 0; }), after = before;
  for (TrialRecord& record : after)
    for (PickRecord& p : record.picks) {  // gives up on the three parts that were hardest
      p.check.estimates.resize(3);
      p.check.found = p.check.found_tight = p.check.right = p.check.counted = 3;
    }
  const Comparison found = compare(set_of("a", before), set_of("b", after), {});
  const MetricComparison& p95 = metric(found, "translation_p95");
  EXPECT_DOUBLE_EQ(p95.base, 0.001);
  EXPECT_TRUE(std::isinf(p95.fresh));
  EXPECT_EQ(p95.finding, Finding::kWorse);
  EXPECT_EQ(metric(found, "recall").finding, Finding::kWorse);
}

TEST(Compare, CrashesAreNoMeasurement) {
  const auto before = piles(30, [](std::size_t) { return 0; });
  std::vector<TrialRecord> after = before;
  after[4].error = "the worker died of signal 11";
  after[4].picks.assign(1, pick(PickOutcome::kInternalError, 0, 0));
  const Comparison crashed = compare(set_of("a", before), set_of("b", after), {});
  EXPECT_EQ(crashed.pairs, 29u);
  EXPECT_EQ(crashed.crashes, std::vector<std::uint64_t>{4});
  EXPECT_EQ(metric(crashed, "picks").loss, 0);
  EXPECT_EQ(exit_code(crashed), 5);
  GateRules rules;
  rules.crash_budget = 1;
  EXPECT_EQ(exit_code(compare(set_of("a", before), set_of("b", after), rules)), 0);
}

TEST(Compare, PairsBySeedAndNeedsACommonOne) {
  const auto all = piles(30, [](std::size_t) { return 0; });
  const std::vector<TrialRecord> early(all.begin(), all.begin() + 20), late(all.begin() + 15, all.end());
  const Comparison overlap = compare(set_of("a", early), set_of("b", late), {});
  EXPECT_EQ(overlap.pairs, 5u);
  EXPECT_EQ(overlap.only_base, 15u);
  EXPECT_EQ(overlap.only_fresh, 10u);
  const std::vector<TrialRecord> first(all.begin(), all.begin() + 10);
  EXPECT_THROW(compare(set_of("a", first), set_of("b", late), {}), SpecError);
}

TEST(Baseline, ReadsBackAndIsStrict) {
  std::vector<TrialRecord> records = piles(5, [](std::size_t i) { return static_cast<int>(i); });
  records[2].picks[0].check.found = 4;
  const PileSet set = set_of("run", records);
  const std::string text = baseline_text(set);
  const PileSet back = baseline_from(text, "base.jsonl");
  EXPECT_EQ(baseline_text(back), text);
  EXPECT_EQ(compare(back, set, {}).verdict, Verdict::kNoBitChanged);
  const auto message = [](const std::string& bad) {
    try {
      baseline_from(bad, "base.jsonl");
    } catch (const SpecError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(message(""), HasSubstr("base.jsonl:1: the file is cut off"));
  EXPECT_THAT(message("[]\n"), HasSubstr("base.jsonl:1: : is not an object"));
  EXPECT_THAT(message(text.substr(0, text.size() - 3)), HasSubstr("base.jsonl:6: the file is cut off"));
  EXPECT_THAT(message(text.substr(0, text.rfind("{\"seed\""))), HasSubstr("holds 4 piles, its first line says 5"));
  std::string wrong = text;
  wrong.replace(wrong.find("\"missed\""), 8, "\"mist\"  ");
  EXPECT_THAT(message(wrong), HasSubstr("base.jsonl:2: missed: is missing"));
  wrong = text;
  wrong.replace(wrong.find("\"picks\":[10.0,10.0]"), 19, "\"picks\":[11.0,10.0]");
  EXPECT_THAT(message(wrong), HasSubstr("base.jsonl:2: picks: is not [hits, total]"));
}

TEST(GateRules, ReadFromYaml) {
  GateRules rules;
  read_yaml_text("alpha: 0.01\npicks: {margin: 0.02}\ntranslation_p95: {margin: 0.3 mm}\ncycle: {gate: false}\n",
                 "m.yaml", ".", [&](ConfigVisitor& v) { rules.visit(v); });
  EXPECT_EQ(rules.alpha, 0.01);
  EXPECT_EQ(rules.picks.margin, 0.02);
  EXPECT_DOUBLE_EQ(rules.translation_p95.margin, 0.3e-3);
  EXPECT_FALSE(rules.cycle.gate);
  EXPECT_TRUE(rules.recall.gate);
  EXPECT_THROW(read_yaml_text("picks: {margin: 0}\n", "m.yaml", ".", [&](ConfigVisitor& v) { rules.visit(v); }),
               SpecError);
  rules.alpha = 0.7;
  EXPECT_THROW(rules.validate(), SpecError);
}

TEST(Verdict, JsonMarkdownAndJUnit) {
  const auto before = piles(60, [](std::size_t i) { return i % 2; });
  std::vector<TrialRecord> after = piles(60, [](std::size_t i) { return i % 2 + (i % 4 < 2 ? 2 : 0); });
  for (TrialRecord& record : after) record.scenario = "a <b> & \x01 \"c\"";
  const Comparison found = compare(set_of("a", before), set_of("b", after), {});
  const nlohmann::json json = nlohmann::json::parse(comparison_json(found));
  EXPECT_EQ(json.at("verdict"), "worse");
  EXPECT_EQ(json.at("exit_code"), 1);
  EXPECT_EQ(json.at("flips").size(), found.flips.size());
  EXPECT_EQ(json.at("metrics").size(), 12u);
  EXPECT_THAT(comparison_markdown(found), HasSubstr("| picks succeeded | 95.0 % | 85.0 % |"));
  tinyxml2::XMLDocument xml;
  ASSERT_EQ(xml.Parse(comparison_junit(found).c_str()), tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement* suite = xml.RootElement()->FirstChildElement("testsuite");
  EXPECT_STREQ(suite->Attribute("name"), "binpick a <b> &   \"c\"");
  int cases = 0, failures = 0, skipped = 0;
  for (const tinyxml2::XMLElement* c = suite->FirstChildElement("testcase"); c; c = c->NextSiblingElement("testcase")) {
    ++cases;
    failures += c->FirstChildElement("failure") ? 1 : 0;
    skipped += c->FirstChildElement("skipped") ? 1 : 0;
  }
  EXPECT_EQ(suite->IntAttribute("tests"), cases);
  EXPECT_EQ(suite->IntAttribute("failures"), failures);
  EXPECT_EQ(suite->IntAttribute("skipped"), skipped);
  EXPECT_GE(failures, 2);  // the verdict and the picks
}

}  // namespace
}  // namespace binpick

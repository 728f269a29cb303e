// Reports: the right figures in the right units, beside the paper's; hostile texts stay text.
#include "evaluation/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using examples::campaign;
using examples::matched;
using examples::pick;
using examples::trial;
using testing::HasSubstr;
using testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++found;
  return found;
}

TEST(MarkdownReport, StandsBesideThePaper) {
  const std::string report = markdown_report(summarise(campaign(), 1000));
  EXPECT_THAT(report, HasSubstr("19 / 20"));
  EXPECT_THAT(report, HasSubstr("95.0 %"));
  EXPECT_THAT(report, HasSubstr("48 / 50 = 96.0 % (Wilson 86.5 - 98.9 %)"));
  EXPECT_THAT(report, HasSubstr("2.02 / 0.61 / 2.08"));
  EXPECT_THAT(report, HasSubstr("0.87 / 0.40 / 0.84"));
  EXPECT_THAT(report, HasSubstr("0.60 / 0.00 / 0.80"));  // ours: 1 mm along (0.6, 0, 0.8)
  EXPECT_THAT(report, HasSubstr("0.06 / 0.11 / 0.17"));  // ours: 1, 2 and 3 mrad in degrees
  EXPECT_THAT(report, HasSubstr("mean of Y is then 0.73"));
  EXPECT_THAT(report, HasSubstr("average 0.47"));
  EXPECT_THAT(report, HasSubstr("| pre-processing | 20 | 20 | 20 | 395 |"));
  EXPECT_THAT(report, HasSubstr("| PPF voting | 300 | 300 | 300 | 3342 |"));
  EXPECT_THAT(report, HasSubstr("| ICP | 40 | 40 | 40 | 300 |"));
  EXPECT_THAT(report, HasSubstr("| moving robot (simulated) | 8000 | - | - | 8536 |"));
  EXPECT_THAT(report, HasSubstr("| total | 8510 | - | - | 12573 |"));  // 460 + 50 + 8000
  EXPECT_THAT(report, HasSubstr("| NoSeal | 1 |"));
  EXPECT_THAT(report, HasSubstr("5001"));
}

TEST(MarkdownReport, HostileNamesStayInTheirCell) {
  std::vector<TrialRecord> records = campaign();
  records[0].scenario = "a|b <script>\n# head";
  const std::string report = markdown_report(summarise(records, 0));
  EXPECT_THAT(report, Not(HasSubstr("<script>")));
  EXPECT_THAT(report, Not(HasSubstr("\n# head")));
}

TEST(SideBySide, OneRowACampaignInTheOrderGiven) {
  const std::vector<TrialRecord> all = campaign();
  const std::vector<NamedSummary> campaigns = {{"b|2", summarise({&all[1], 1}, 0)}, {"a1", summarise(all, 0)}};
  const std::string table = side_by_side(campaigns, true);
  EXPECT_EQ(count(table, "\n"), 5u);  // head, rule, two rows, a blank line
  EXPECT_LT(table.find("b\\|2 | 1 |"), table.find("| a1 | 2 |"));
  EXPECT_THAT(table, HasSubstr("9 / 10 = 90.0 %"));
  EXPECT_THAT(table, HasSubstr("19 / 20 = 95.0 %"));
  EXPECT_THAT(table, HasSubstr("| 1.00 / 1.00 |"));  // every error is 1 mm
  EXPECT_EQ(count(side_by_side(campaigns, false), "\n"), 3u);
}

TEST(TerminalTable, IsShortAndPlain) {
  const std::string table = terminal_table(summarise(campaign(), 1000));
  EXPECT_THAT(table, HasSubstr("bearing_bin, 2 trials. 95.0 % of 20 parts cleared"));
  EXPECT_THAT(table, HasSubstr("not distinguishable from the paper's 96.0 %"));
  EXPECT_LT(count(table, "\n"), 45u);
  for (const char c : table) EXPECT_TRUE(c == '\n' || (c >= 0x20 && c < 0x7f));
  EXPECT_THAT(table, Not(HasSubstr("nan")));
  EXPECT_THAT(terminal_table(summarise({}, 0)), Not(HasSubstr("nan")));
}

TEST(Verdict, SaysWhatCanBeSaid) {
  std::vector<TrialRecord> records;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    records.push_back(trial(seed, std::vector<PickRecord>(4 + seed % 2, pick(PickOutcome::kSucceeded, 1, 1))));
  }
  EXPECT_THAT(terminal_table(summarise(records, 0)), HasSubstr("below the paper's 96.0 %"));
  // All of 20 parts is no proof against 48 of 50; all of 200 is.
  records.assign(20, trial(0, {pick(PickOutcome::kSucceeded, 1, 1)}, 1));
  EXPECT_THAT(terminal_table(summarise(records, 0)), HasSubstr("not distinguishable from the paper's 96.0 %"));
  records.assign(20, trial(0, std::vector<PickRecord>(10, pick(PickOutcome::kSucceeded, 1, 1))));
  for (std::uint64_t seed = 0; seed < 20; ++seed) records[seed].seed = Seed{seed};
  EXPECT_THAT(terminal_table(summarise(records, 0)), HasSubstr("above the paper's 96.0 %"));
}

TEST(PicksCsv, OneRowPerPickAndQuotedWhereNeeded) {
  std::vector<TrialRecord> records = campaign();
  records[1].picks[9].reason = "blocked, by \"the wall\"\nand more";
  records[1].picks[8].reason = "=HYPERLINK(1)";
  const std::string csv = picks_csv(records);
  EXPECT_EQ(count(csv, "\nbearing_bin,500"), 20u);
  EXPECT_EQ(csv.rfind("scenario,seed,pick,outcome,reason,", 0), 0u);
  EXPECT_THAT(
      csv,
      HasSubstr("bearing_bin,5001,9,NoSeal,\"blocked, by \"\"the wall\"\"\nand more\",2,1,1,1,0,1,1.000,0.573,3.000,"));
  EXPECT_THAT(csv, HasSubstr(",'=HYPERLINK(1),"));
  EXPECT_THAT(csv, HasSubstr(",12.35,"));  // place error of 12.3456.. mm
  const std::string header = csv.substr(0, csv.find('\n')), row = csv.substr(csv.find('\n') + 1);
  EXPECT_EQ(count(header, ","), count(row.substr(0, row.find('\n')), ","));
}

}  // namespace
}  // namespace binpick

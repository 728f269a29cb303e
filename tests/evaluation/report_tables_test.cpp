// Tables of a report: what they count, and their four faces.
#include "evaluation/report_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using examples::matched;
using examples::pick;
using examples::trial;
using testing::HasSubstr;

/// One look at three parts of 0.1 m: the highest seen whole and found 3 mm off, the next 60 % visible and 20 mm off,
/// the lowest 30 % visible and found 1.5 mm off.
std::vector<TrialRecord> three_parts() {
  PickRecord look = pick(PickOutcome::kSucceeded, 0, 0);
  look.seen = {{0, 0.1, 0.6, 0.03}, {0, 0.1, 1.0, 0.05}, {0, 0.1, 0.3, 0.01}};
  look.check.estimates = {matched(0, 1, true, 0.001), matched(1, 0, false, 0.02 / 3), matched(2, 2, true, 0.0005)};
  PickRecord empty = pick(PickOutcome::kNoReachablePick, 0, 0);
  empty.seen = {{0, 0.1, 0.6, 0.03}, {0, 0.1, 0.3, 0.01}};
  empty.check.estimates.clear();
  return {trial(7, {look, empty}, 3)};
}

ReportTable table(const std::vector<TrialRecord>& records, const std::string& id) {
  for (ReportTable& found : report_tables(summarise(records, 0), records))
    if (found.id == id) return found;
  ADD_FAILURE() << id;
  return {};
}

double number(const ReportTable& found, std::size_t row, const std::string& key) {
  for (std::size_t i = 0; i < found.columns.size(); ++i)
    if (found.columns[i].key == key) return std::get<double>(found.rows.at(row).at(i));
  ADD_FAILURE() << key;
  return 0;
}

TEST(ReportTables, RecallByThresholdCountsWhatIsHalfVisible) {
  const ReportTable found = table(three_parts(), "recall_by_threshold");
  // Half visible: two at the first look (3 mm = 0.03 and 20 mm = 0.2 diameters off), one at the second, not found.
  EXPECT_DOUBLE_EQ(number(found, 3, "threshold_d"), 0.03);
  EXPECT_DOUBLE_EQ(number(found, 2, "recall_pct"), 0);
  EXPECT_NEAR(number(found, 4, "recall_pct"), 100.0 / 3, 1e-9);
  EXPECT_NEAR(number(found, 19, "recall_pct"), 100.0 / 3, 1e-9);
  EXPECT_NEAR(number(found, 5, "recall_mm_pct"), 0, 1e-9);          // 2.5 mm
  EXPECT_NEAR(number(found, 7, "recall_mm_pct"), 100.0 / 3, 1e-9);  // 3.5 mm
}

TEST(ReportTables, RecallByVisibilityAndRank) {
  const ReportTable bins = table(three_parts(), "recall_by_visibility");
  EXPECT_DOUBLE_EQ(number(bins, 3, "instances"), 2);  // 30 %, seen twice
  EXPECT_DOUBLE_EQ(number(bins, 3, "found"), 1);
  EXPECT_DOUBLE_EQ(number(bins, 9, "recall_pct"), 100);
  EXPECT_DOUBLE_EQ(number(bins, 6, "found"), 0);
  const ReportTable ranks = table(three_parts(), "recall_by_rank");
  ASSERT_EQ(ranks.rows.size(), 3u);
  EXPECT_DOUBLE_EQ(number(ranks, 0, "instances"), 2);  // the whole one, and the 60 % one once that is gone
  EXPECT_DOUBLE_EQ(number(ranks, 0, "found"), 1);
  EXPECT_DOUBLE_EQ(number(ranks, 1, "visible"), 1);
  EXPECT_DOUBLE_EQ(number(ranks, 2, "found"), 1);
}

TEST(ReportTables, ABinEmpties) {
  const ReportTable curve = table(three_parts(), "emptying");
  ASSERT_EQ(curve.rows.size(), 3u);
  EXPECT_DOUBLE_EQ(number(curve, 0, "left_mean"), 3);
  EXPECT_DOUBLE_EQ(number(curve, 1, "left_mean"), 2);
  EXPECT_DOUBLE_EQ(number(curve, 2, "left_mean"), 2);
  const ReportTable left = table(three_parts(), "picks_by_parts_left");
  EXPECT_DOUBLE_EQ(number(left, 0, "parts_left"), 2);
  EXPECT_DOUBLE_EQ(number(left, 0, "succeeded"), 0);
  EXPECT_DOUBLE_EQ(number(left, 1, "success_pct"), 100);
  EXPECT_DOUBLE_EQ(number(left, 1, "cycle_median_s"), 9);
}

TEST(ReportTables, ErrorsByAxisStandBesideThePaper) {
  const std::vector<TrialRecord> records = {trial(1, {pick(PickOutcome::kSucceeded, 2, 2)})};
  const ReportTable axes = table(records, "errors_by_axis");
  EXPECT_DOUBLE_EQ(number(axes, 0, "mean_abs"), 0.6);  // 1 mm along (0.6, 0, 0.8)
  EXPECT_DOUBLE_EQ(number(axes, 2, "p95_abs"), 0.8);
  EXPECT_NEAR(number(axes, 3, "median_abs"), 0.0573, 1e-4);  // 1 mrad
  EXPECT_DOUBLE_EQ(number(axes, 2, "paper_mean_abs"), 2.08);
  EXPECT_DOUBLE_EQ(number(table(records, "error_cdf"), 50, "translation_mm"), 1);
}

TEST(ReportTables, RecordsWithoutWhatWasSeenHaveNoRecallRows) {
  std::vector<TrialRecord> records = three_parts();
  for (PickRecord& p : records[0].picks) p.seen.clear();
  EXPECT_TRUE(table(records, "recall_by_visibility").rows.empty());
  EXPECT_FALSE(table(records, "emptying").rows.empty());
}

TEST(ReportTable, FourFaces) {
  ReportTable made{"t", "A <title>", "a note", {{"name", "name", -1}, {"x_mm", "x, mm", 2}}, {}};
  made.add({"a,\"b\"<c>", 1.005});
  made.add({"=1+1", std::nan("")});
  EXPECT_EQ(table_csv(made), "name,x_mm\n\"a,\"\"b\"\"<c>\",1.00\n'=1+1,\n");
  EXPECT_THAT(table_markdown(made), HasSubstr("| =1+1 | - |"));
  EXPECT_THAT(table_markdown(made), HasSubstr("\\<c\\>"));
  EXPECT_THAT(table_html(made), HasSubstr("<td>a,&quot;b&quot;&lt;c&gt;</td><td class=\"n\">1.00</td>"));
  const nlohmann::json json = nlohmann::json::parse(tables_json({made}));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["tables"][0]["rows"][0][1], 1.0);
  EXPECT_TRUE(json["tables"][0]["rows"][1][1].is_null());
  EXPECT_THROW(made.add({"too short"}), std::exception);
}

TEST(ReportTables, EveryColumnIsDocumented) {
  const std::string document = read_file(BINPICK_SOURCE_DIR "/docs/report.md");
  for (const ReportTable& found : report_tables(summarise(three_parts(), 0), three_parts())) {
    EXPECT_NE(document.find("`" + found.id + "`"), std::string::npos) << found.id;
    for (const TableColumn& column : found.columns)
      EXPECT_NE(document.find("`" + column.key + "`"), std::string::npos) << found.id << ": " << column.key;
  }
}

}  // namespace
}  // namespace binpick

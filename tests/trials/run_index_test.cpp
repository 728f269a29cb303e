// A run's records in SQL: the figures are the records', the index follows them, and nothing can be changed through it.

#include "trials/run_index.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "evaluation/trial_record.hpp"
#include "tests/core/temp_folder.hpp"
#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using examples::matched;
using examples::pick;
using examples::trial;
using ::testing::HasSubstr;

class Index : public ::testing::Test {
 protected:
  Index() : run_(folder_.at("run")) {
    make_folder(run_ + "/records");
    PickRecord good = pick(PickOutcome::kSucceeded, 4, 3);
    good.sim_time = 8.25;
    good.check.estimates = {matched(0, 2, true, 0.00125), matched(1, 0, false, 0.02)};
    TrialRecord crashed = trial(7, {});
    crashed.failure = TrialFailure::kCrash;
    keep({trial(5, {good, pick(PickOutcome::kNoSeal, 3, 3)}), crashed});
  }
  void keep(const std::vector<TrialRecord>& records) const {
    std::string text;
    for (const TrialRecord& record : records) text += to_json_line(record) + "\n";
    write_file(run_ + "/records/records.jsonl", text);
  }
  std::vector<std::vector<std::string>> ask(const std::string& statement) const {
    std::vector<std::vector<std::string>> rows;
    for (const auto& row : query_run(run_, statement).rows) {
      auto& texts = rows.emplace_back();
      for (const QueryCell& cell : row) texts.push_back(cell.kind == QueryCell::Kind::kNull ? "NULL" : cell.text);
    }
    return rows;
  }
  std::string refusal(const std::string& statement) const {
    try {
      query_run(run_, statement);
    } catch (const SpecError& error) {
      return error.what();
    }
    return "";
  }
  TempFolder folder_;
  std::string run_;
};

using Rows = std::vector<std::vector<std::string>>;

TEST_F(Index, HoldsTheFiguresOfTheRecords) {
  EXPECT_EQ(ask("select seed, failure from trials order by seed"), (Rows{{"5", "NULL"}, {"7", "Crash"}}));
  EXPECT_EQ(ask("select turn, outcome, sim_time_s, visible, found from picks where seed = 5 and turn = 0"),
            (Rows{{"0", "Succeeded", "8.25", "4", "3"}}));
  EXPECT_EQ(ask("select outcome from picks where turn = 1"), (Rows{{"NoSeal"}}));
  EXPECT_EQ(ask("select instance, right from estimates where right and turn = 0"), (Rows{{"2", "1"}}));
  EXPECT_EQ(query_run(run_, "select 1 as one, 'x' as letter").columns, (std::vector<std::string>{"one", "letter"}));
}

TEST_F(Index, FollowsTheRecordsAndIsNoTruthOfItsOwn) {
  ask("select 1");
  ASSERT_TRUE(std::filesystem::exists(run_ + "/index.sqlite"));
  keep({trial(9, {})});
  EXPECT_EQ(ask("select seed from trials"), (Rows{{"9"}}));
  write_file(run_ + "/index.sqlite", "no database at all");
  EXPECT_EQ(ask("select seed from trials"), (Rows{{"9"}}));
}

TEST_F(Index, OnlyReads) {
  EXPECT_THAT(refusal("delete from picks"), HasSubstr("only statements that read"));
  EXPECT_THAT(refusal("select 1; select 2"), HasSubstr("one statement"));
  EXPECT_THAT(refusal("select seed from elsewhere"), HasSubstr("no such table"));
  EXPECT_THAT(refusal(" "), HasSubstr("no statement"));
  EXPECT_EQ(ask("select count(*) from picks"), (Rows{{"2"}}));
}

TEST_F(Index, TellsWhatIsNoRun) {
  EXPECT_THROW(query_run(folder_.at("nothing"), "select 1"), SpecError);
  write_file(run_ + "/records/records.jsonl", "noise\n");
  EXPECT_THAT(refusal("select 1"), HasSubstr("records.jsonl:1"));
}

}  // namespace
}  // namespace binpick

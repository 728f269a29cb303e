// The records of a run folder: torn tails are cut, everything else that is wrong is told.

#include "trials/run_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "tests/core/temp_folder.hpp"

namespace binpick {
namespace {

using ::testing::HasSubstr;

TrialRecord record_of(std::uint64_t seed, const std::string& build = "b1") {
  TrialRecord record;
  record.scenario = "tiny";
  record.scenario_hash = "5ce0";
  record.seed = Seed{seed};
  record.dropped = 3;
  record.build = build;
  return record;
}

class Store : public ::testing::Test {
 protected:
  Store() : run_(folder_.at("run")) {}
  std::string file() const { return run_ + "/records/records.jsonl"; }
  void fill(std::uint64_t seeds, const std::string& build = "b1") {
    RunStore store(run_, "5ce0", build);
    store.begin();
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) store.append(record_of(seed, build));
  }
  std::set<std::uint64_t> recorded() { return RunStore(run_, "5ce0", "b1").recorded(); }
  std::string refusal() {
    try {
      recorded();
    } catch (const SpecError& error) {
      return error.what();
    }
    return "";
  }

  TempFolder folder_;
  std::string run_;
};

using Seeds = std::set<std::uint64_t>;

TEST_F(Store, HoldsWhatWasAppended) {
  EXPECT_EQ(recorded(), Seeds());
  fill(3);
  EXPECT_EQ(recorded(), (Seeds{1, 2, 3}));
}

TEST_F(Store, CutsATornLineWhereverItWasTorn) {
  fill(3);
  const std::string whole = read_file(file());
  const std::size_t last = whole.rfind('\n', whole.size() - 2) + 1;
  for (std::size_t end = last; end < whole.size(); ++end) {
    write_file(file(), whole.substr(0, end));
    EXPECT_EQ(recorded(), (Seeds{1, 2})) << end;
    EXPECT_EQ(read_file(file()), whole.substr(0, last)) << end;
  }
}

TEST_F(Store, CutsALastLineWhoseBytesNeverReachedTheDisk) {
  fill(3);
  std::string bytes = read_file(file());
  for (std::size_t i = bytes.size() - 60; i + 1 < bytes.size(); ++i) bytes[i] = '\0';
  write_file(file(), bytes);
  EXPECT_EQ(recorded(), (Seeds{1, 2}));
}

TEST_F(Store, TellsADamagedLineInTheMiddleByItsSum) {
  fill(3);
  std::string bytes = read_file(file());
  const std::size_t wall = bytes.find("\"total\":0.0");
  ASSERT_NE(wall, std::string::npos);
  bytes[wall + 10] = '7';  // outside the record's hash
  write_file(file(), bytes);
  EXPECT_THAT(refusal(), HasSubstr("records.jsonl:1: sum: does not fit"));
  EXPECT_EQ(read_file(file()), bytes) << "nothing is lost";
}

TEST_F(Store, RefusesAnotherScenarioAndAnotherBuild) {
  fill(2, "b0");
  EXPECT_THAT(refusal(), HasSubstr("another build of the program (b0, not b1)"));
  EXPECT_THROW(RunStore(run_, "other", "b0").recorded(), SpecError);
  EXPECT_EQ(RunStore(run_, "5ce0", "b0").recorded(), (Seeds{1, 2}));
}

TEST_F(Store, LetsOneInAtATime) {
  fill(1);
  {
    RunStore first(run_, "5ce0", "b1");
    first.recorded();
    EXPECT_THAT(refusal(), HasSubstr("another campaign is at work"));
  }
  EXPECT_EQ(refusal(), "");
}

}  // namespace
}  // namespace binpick

// Campaigns through the program: the same records on any number of workers, replay bit for bit, nothing lost.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "evaluation/trial_record.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kRoot = BINPICK_SOURCE_DIR;

std::string small_scene(const TemporaryFolder& folder, const std::string& estimator) {
  write_file(folder.path("scene.yaml"),
             "name: small\npart: " + kRoot + "/assets/parts/bearing_6914/part.yaml\ncount: 4\ncell: " + kRoot +
                 "/assets/cells/mz07_three_cups.yaml\nestimator: {type: " + estimator + "}\ntrial: {max_picks: 2}\n");
  return folder.path("scene.yaml");
}

// Everything of a record line but its wall times and the program that ran it.
std::string without_wall(const std::string& line) {
  nlohmann::ordered_json record = nlohmann::ordered_json::parse(line);
  for (const char* key : {"wall", "build", "sum"}) record.erase(key);
  return record.dump();
}

std::map<std::uint64_t, std::string> records_of(const std::string& run) {
  std::map<std::uint64_t, std::string> records;
  std::ifstream file(run + "/records/records.jsonl");
  for (std::string line; std::getline(file, line);) records[json::parse(line).at("seed")] = without_wall(line);
  return records;
}

TEST(Campaign, TheSameRecordsOnOneAndTwoWorkersAndInReplay) {
  const TemporaryFolder folder;
  const std::string scene = small_scene(folder, "paper_ppf");
  for (const std::string workers : {"1", "2"}) {
    const ProgramRun run = run_program("campaign " + scene + " --seeds 20:24 --workers " + workers + " --out " +
                                       folder.path("run" + workers));
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, testing::HasSubstr("picks"));
  }
  const auto one = records_of(folder.path("run1")), two = records_of(folder.path("run2"));
  ASSERT_EQ(one.size(), 4u);
  EXPECT_EQ(one, two);
  for (const char* file :
       {"scenario.yaml", "summary.json", "environment.json", "report.html", "results.md", "picks.csv"})
    EXPECT_TRUE(fs::exists(folder.path("run1") + "/" + file)) << file;
  EXPECT_EQ(json::parse(read_file(folder.path("run1/summary.json"))).at("records_hash"),
            json::parse(read_file(folder.path("run2/summary.json"))).at("records_hash"));
  EXPECT_TRUE(fs::exists(folder.path("run1/artifacts/seed-20/00_estimates.png")));

  // The run's own check says the same, and finds what was changed.
  const ProgramRun same = run_program("verify " + folder.path("run2") + " --sample 2");
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  EXPECT_THAT(same.out, testing::HasSubstr("2 of 2 records came out again"));
  std::vector<TrialRecord> changed = read_records(folder.path("run2"));
  for (TrialRecord& record : changed) record.picks.at(0).estimates_hash ^= 1;
  std::string text;
  for (const TrialRecord& record : changed) text += to_json_line(record) + "\n";
  write_file(folder.path("run2/records/records.jsonl"), text);
  const ProgramRun other = run_program("verify " + folder.path("run2") + " --sample 1");
  EXPECT_EQ(other.code, 7) << other.err;
  EXPECT_THAT(other.out, testing::HasSubstr("differs first in turn 0: estimates: binpick trial"));

  // A record replays from the scene and from the run folder's own expanded scenario.
  for (const std::string& source : {scene, folder.path("run1/scenario.yaml")}) {
    const ProgramRun replay = run_program("trial " + source + " --seed 22");
    ASSERT_EQ(replay.code, 0) << replay.err;
    EXPECT_EQ(without_wall(replay.out), one.at(22)) << source;
  }
}

TEST(Campaign, CompletesAFolderAndRefusesAnotherScenario) {
  const TemporaryFolder folder;
  const std::string scene = small_scene(folder, "oracle");
  ASSERT_EQ(run_program("campaign " + scene + " --seeds 1:3 --out " + folder.path("run")).code, 0);
  const auto before = records_of(folder.path("run"));
  ASSERT_EQ(run_program("campaign " + scene + " --seeds 1:5 --workers 2 --out " + folder.path("run")).code, 0);
  const auto after = records_of(folder.path("run"));
  EXPECT_EQ(after.size(), 4u);
  EXPECT_EQ(after.at(1), before.at(1));
  write_file(scene, read_file(scene) + "drop: {height: 0.2}\n");
  const ProgramRun other = run_program("campaign " + scene + " --seeds 1:3 --out " + folder.path("run"));
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, testing::HasSubstr("another scenario"));
  EXPECT_EQ(records_of(folder.path("run")), after);
}

TEST(Campaign, AnInterruptFinishesWhatIsInFlightAndCanBeResumed) {
  const TemporaryFolder folder;
  const std::string scene = small_scene(folder, "oracle");
  const std::string campaign = "campaign " + scene + " --seeds 1:9 --out " + folder.path("run");
  const ProgramRun run = run_program(campaign + " & campaign=$!; for i in $(seq 200); do sleep 0.1; [ -s " +
                                         folder.path("run/records/records.jsonl") +
                                         " ] && break; done; kill -INT $campaign; wait $campaign; exit $?",
                                     "set -m");
  EXPECT_EQ(run.code, 130) << run.err;
  EXPECT_THAT(run.err, testing::HasSubstr("went to running them"));
  const auto partial = records_of(folder.path("run"));
  EXPECT_LT(partial.size(), 8u);
  EXPECT_EQ(run_program(campaign).code, 0);
  const auto complete = records_of(folder.path("run"));
  EXPECT_EQ(complete.size(), 8u);
  for (const auto& [seed, line] : partial) EXPECT_EQ(complete.at(seed), line);
}

}  // namespace
}  // namespace binpick
